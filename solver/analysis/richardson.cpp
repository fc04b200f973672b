#include "solver/analysis/richardson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/base/root_finding.hpp"

namespace myowave::solver {

std::optional<double> observed_order(const std::array<double, 3>& h, double first_difference,
                                     double second_difference) {
  constexpr double smallest = 0.25, largest = 8;
  const double seen = first_difference / second_difference;
  // Grows with p.
  const auto ratio = [&](double p) {
    return (std::pow(h[0], p) - std::pow(h[1], p)) / (std::pow(h[1], p) - std::pow(h[2], p));
  };
  if (!(seen >= ratio(smallest) && seen <= ratio(largest))) return std::nullopt;
  constexpr double tolerance = 1e-14;
  return bisect({smallest, largest}, tolerance, [&](double p) { return ratio(p) < seen; }).middle();
}

Extrapolated richardson(std::span<const double> h, std::span<const double> values) {
  constexpr double same = 1e-9;
  const std::size_t n = values.size();
  const double finest = values.back();
  if (n < 2) return {finest, std::numeric_limits<double>::quiet_NaN()};
  const Extrapolated as_is{finest, std::abs(finest - values[n - 2])};
  if (n < 3) return as_is;
  const std::array three{h[n - 3], h[n - 2], h[n - 1]};
  const double first = values[n - 3] - values[n - 2], second = values[n - 2] - finest;
  if (std::min(std::abs(first), std::abs(second)) < same * std::abs(finest)) return as_is;
  const auto order = observed_order(three, first, second);
  if (!order) return as_is;
  const double p = *order;
  const double beyond = second * std::pow(three[2], p) / (std::pow(three[1], p) - std::pow(three[2], p));
  return {finest - beyond, std::abs(beyond), order};
}

}  // namespace myowave::solver
