// The maps that `myowave stability` can make. A new one is one more entry in the list.
#pragma once

#include <string_view>
#include <vector>

#include "solver/studies/map_table.hpp"

namespace myowave::solver {

struct StabilityMap {
  std::string_view name;
  std::string_view doc;  // one line for --help
  MapTable (*make)(const MapProgress&);
};

const std::vector<StabilityMap>& stability_maps();

}  // namespace myowave::solver
