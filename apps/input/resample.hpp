// The same sheet on a grid of another spacing: `accuracy.dx` and `initial.dx`.
#pragma once

#include <span>
#include <vector>

#include "solver/scene/grid_spacing.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

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
