#include "solver/mechanics/equibiaxial.hpp"

#include <cmath>

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
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return std::sqrt(middle);
    (tension(middle) < 0 ? low : high) = middle;
  }
}

}  // namespace myowave::solver
