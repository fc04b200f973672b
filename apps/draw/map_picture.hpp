// A map of stability as a picture with axes, units and legend.
#pragma once

#include <string>

#include "solver/studies/map_table.hpp"

namespace myowave::apps {

// SVG 1.1 of a table that has a view.
std::string map_svg(const solver::MapTable&);

}  // namespace myowave::apps
