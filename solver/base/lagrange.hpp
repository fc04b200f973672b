// Lagrange interpolation.
#pragma once

#include <span>
#include <vector>

namespace myowave::solver {

// Weights, of sum 1, with which values at distinct `points` give their Lagrange polynomial at x.
std::vector<double> lagrange_weights(std::span<const double> points, double x);

}  // namespace myowave::solver
