#include "solver/mechanics/equibiaxial.hpp"

#include <cmath>

#include "solver/base/root_finding.hpp"

namespace myowave::solver {

std::optional<double> equibiaxial_stretch(const MechanicsSettings& settings, double Ta) {
  // What is left of the tension at s; negative at s -> 0, where the sheet resists being closed up.
  const auto tension = [&](double s) {
    const double load = settings.p * (settings.load == Load::follower ? s : std::sqrt(s));
    return 2 * (s - 1 / (s * s)) * (settings.c1 + settings.c2 * s) + Ta - load;
  };
  constexpr double largest = 1e12;  // of lambda^2: no sheet
  double low = 1, high = 1;
  while (!(tension(low) <= 0)) {
    low /= 2;
    if (low < 1 / largest) return std::nullopt;
  }
  while (!(tension(high) > 0)) {
    high *= 2;
    if (high > largest) return std::nullopt;
  }
  return std::sqrt(bisect({low, high}, 0, [&](double s) { return tension(s) < 0; }).middle());
}

}  // namespace myowave::solver
