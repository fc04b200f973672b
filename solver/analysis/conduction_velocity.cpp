#include "solver/analysis/conduction_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace myowave::solver {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
// length/t.u.: the plane wave has 1.5 to 1.6; a front about to be blocked is still faster.
constexpr double slowest = 0.125;
constexpr double largest_turn = 0.5;  // of the slopes to both sides, over |grad T|

// The slope along one side from the differences to both neighbours, over the spacing; nan outside of the
// sheet.
struct Slope {
  double behind, ahead;

  double value() const {
    if (std::isnan(behind)) return std::isnan(ahead) ? 0 : ahead;
    return std::isnan(ahead) ? behind : 0.5 * (behind + ahead);
  }
  double turn() const { return std::isnan(behind) || std::isnan(ahead) ? 0 : std::abs(ahead - behind); }
};

}  // namespace

std::vector<double> conduction_velocity(int rows, int columns, double dx,
                                        std::span<const double> activation) {
  std::vector<double> velocity(activation.size(), none);
  const auto at = [&](int i, int j) { return activation[static_cast<std::size_t>(i) * columns + j]; };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      bool one_front = std::isfinite(at(i, j));
      const auto slope = [&](int di, int dj) {
        const int a = i + di, b = j + dj;
        if (a < 0 || a >= rows || b < 0 || b >= columns) return none;
        const double difference = (at(a, b) - at(i, j)) / dx;
        if (!(std::abs(difference) <= 1 / slowest)) one_front = false;
        return difference;
      };
      const Slope x{-slope(0, -1), slope(0, 1)}, y{-slope(-1, 0), slope(1, 0)};
      const double gradient = std::hypot(x.value(), y.value());
      if (one_front && std::hypot(x.turn(), y.turn()) <= largest_turn * gradient && gradient > 0)
        velocity[static_cast<std::size_t>(i) * columns + j] = 1 / gradient;
    }
  return velocity;
}

Quartiles quartiles(std::span<const double> values) {
  std::vector<double> sorted;
  std::ranges::copy_if(values, std::back_inserter(sorted), [](double v) { return std::isfinite(v); });
  if (sorted.empty()) return {none, none, none, 0};
  std::ranges::sort(sorted);
  const auto at = [&](double fraction) {
    const double place = fraction * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const auto above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
  };
  return {at(0.25), at(0.5), at(0.75), static_cast<std::int64_t>(sorted.size())};
}

}  // namespace myowave::solver
