// The same sheet on a grid of another spacing: `accuracy.dx` and `initial.dx`.
#pragma once

#include <span>
#include <vector>

#include "solver/scene.hpp"

namespace myowave::apps {

// Whether the sheet's sides are whole numbers of dx, length units, to rounding.
bool divides_sheet(const solver::GridSettings& sheet, double dx);

// The sheet with the nodes that it has at a spacing which divides it.
solver::GridSettings with_spacing(const solver::GridSettings& sheet, double dx);

// The grid that a scene's start is made on, in whose nodes its keys of [initial] are.
solver::GridSettings grid_of_start(const solver::Scene&);

// The largest spacing up to accuracy.dx of which the elements of the sheet, or the sides of a rigid one, are
// whole numbers; grid.dx where accuracy.dx is 0.
double spacing_of_run(const solver::Scene&);

// Puts the scene on the grid of that spacing. The sheet and its elements keep their sides, and what is
// counted in node spacings, the start's keys apart, moves to the nodes nearest to it.
void move_to_spacing(solver::Scene&, double dx);

// A grid field (rows, columns), interpolated by cubics through four nodes along each side, within the range
// of the sixteen that it is made of: a front stays one. At common nodes, a value is the field's own.
std::vector<double> resample(std::span<const double> field, const solver::GridSettings& from,
                             const solver::GridSettings& to);

}  // namespace myowave::apps
