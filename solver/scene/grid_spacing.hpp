// The grid of a sheet at another node spacing.
#pragma once

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Whether the sheet's sides are whole numbers of dx, length units, to rounding.
bool divides_sheet(const GridSettings& sheet, double dx);

// The sheet with the nodes that it has at a spacing which divides it.
GridSettings with_spacing(const GridSettings& sheet, double dx);

// The grid on which the initial state is made; the keys of [initial] count its nodes.
GridSettings grid_of_start(const Scene&);

}  // namespace myowave::solver
