#include "solver/mechanics/rest_state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "solver/base/root_finding.hpp"
#include "solver/mechanics/equibiaxial.hpp"

namespace myowave::solver {

double largest_dead_load(const MechanicsSettings& settings) {
  if (settings.c2 == 0) return std::numeric_limits<double>::infinity();
  const auto resistance = [&](double s) {
    return settings.c1 * (1 + 1 / (s * s * s)) + settings.c2 * (3 / (s * s) - s);
  };
  double high = 2;
  while (resistance(high) > 0) high *= 2;
  const double s = bisect({1, high}, 0, [&](double at) { return resistance(at) > 0; }).middle();
  return 2 * (s - 1 / (s * s)) * (settings.c1 + settings.c2 * s) / std::sqrt(s);
}

std::optional<std::string> why_no_rest_state(const MechanicsSettings& settings) {
  if (settings.edges == Edges::fixed) return {};
  if (settings.load == Load::follower) {
    if (equibiaxial_stretch(settings, 0)) return {};
    return fmt::format(
        "mechanics.p = {}: a sheet with c1 = {} and c2 = {} has no equilibrium under this load; a follower "
        "load with c2 = 0 needs p < 2 c1 = {}",
        settings.p, settings.c1, settings.c2, 2 * settings.c1);
  }
  const double largest = largest_dead_load(settings);
  if (0 <= settings.p && settings.p <= largest) return {};
  return fmt::format(
      "mechanics.p = {}: the sheet is not stable under this dead load, it would {}; with c1 = {} and c2 = {} "
      "a dead load must be {}, a follower load may be any",
      settings.p, settings.p < 0 ? "turn around" : "stretch more one way than the other", settings.c1,
      settings.c2, std::isfinite(largest) ? fmt::format("0 to {:.4g}", largest) : ">= 0");
}

}  // namespace myowave::solver
