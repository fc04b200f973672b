#include "solver/analysis/error_norms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "solver/base/lagrange.hpp"

namespace myowave::solver {

double rms(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, values.size())));
}

std::optional<double> relative_l2(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || a.size() != b.size()) return std::nullopt;
  std::vector<double> difference(a.begin(), a.end());
  for (std::size_t n = 0; n < a.size(); ++n) difference[n] -= b[n];
  const double size = rms(b);
  return size == 0 ? std::nullopt : std::optional(rms(difference) / size);
}

double interpolate_cubic(std::span<const double> times, std::span<const double> values, double t) {
  constexpr std::size_t points = 4;
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times, t) - times.begin());
  const std::size_t n = std::min(points, times.size());
  const std::size_t first = std::min(after > points / 2 ? after - points / 2 : 0, times.size() - n);
  const auto weights = lagrange_weights(times.subspan(first, n), t);
  return std::inner_product(weights.begin(), weights.end(),
                            values.begin() + static_cast<std::ptrdiff_t>(first), 0.0);
}

std::optional<double> tip_distance(std::span<const Tip> a, std::span<const Tip> b) {
  if (a.empty() || b.empty()) return std::nullopt;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const auto& expected : b) {
    double nearest = infinite;
    for (const auto& tip : a)
      if (tip.charge == expected.charge)
        nearest = std::min(nearest, std::hypot(tip.x - expected.x, tip.y - expected.y));
    if (nearest == infinite) return std::nullopt;
    sum += nearest;
  }
  return sum / static_cast<double>(b.size());
}

}  // namespace myowave::solver
