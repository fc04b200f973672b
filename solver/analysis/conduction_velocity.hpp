// Conduction velocity of fronts, from the activation times of the nodes.
#pragma once

#include <span>
#include <vector>

#include "solver/base/sample_statistics.hpp"

namespace myowave::solver {

// 1 / |grad T| at each node, of the activation times T (row-major, rows x columns, nan: none), in length
// units of the undeformed sheet a time unit. T_x = (T_east - T_west) / (2 dx), T_y likewise: second order,
// one-sided on the edges of the sheet, 0 along a side of a single node.
//
// Valid where one front has passed the node and its neighbours; nan
// - where a neighbour has no time, or one so different that the front would cross dx slower than a twelfth
//   of the plane wave (it is of another beat, or was blocked);
// - where the slopes to both sides differ by more than half of |grad T|: a front starts, turns within its own
//   width, or meets another (by 28 degrees or more).
// Curved fronts are slower than plane ones, and a front is faster before an edge that it runs into.
std::vector<double> conduction_velocity(int rows, int columns, double dx, std::span<const double> activation);

// Of the finite values, by linear interpolation of the sorted ones; nan if there is none.
Quartiles quartiles(std::span<const double> values);

}  // namespace myowave::solver
