// Distances of fields, curves and tips from a reference.
#pragma once

#include <optional>
#include <span>

#include "solver/base/tips.hpp"

namespace myowave::solver {

// Root of the mean square; 0 for no values.
double rms(std::span<const double> values);

// rms(a - b) / rms(b). None where the sizes differ, or b is empty or zero.
std::optional<double> relative_l2(std::span<const double> a, std::span<const double> b);

// At t by the cubic through the four points around t. The times rise and cover t, at least one.
double interpolate_cubic(std::span<const double> times, std::span<const double> values, double t);

// Mean distance of b's tips to the nearest of a that has the same charge, length units. None where there is
// no such tip for one of them, or b has none.
std::optional<double> tip_distance(std::span<const Tip> a, std::span<const Tip> b);

}  // namespace myowave::solver
