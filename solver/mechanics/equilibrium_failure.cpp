#include "solver/mechanics/equilibrium_failure.hpp"

#include <fmt/format.h>

#include <cmath>

namespace myowave::solver {
namespace {

std::string what_was_tried(const Effort& effort) {
  std::string text = fmt::format("{} Newton iterations, {} halvings of a step, {} shifts", effort.iterations,
                                 effort.halvings, effort.shifts);
  if (effort.shifts > 0) text += fmt::format(" (largest {:.3g} kPa)", effort.largest_shift);
  if (effort.ramp_reached >= 0) {
    text += fmt::format(", and a ramp of the tension that stopped at {:.0f} % after {} parts",
                        100 * effort.ramp_reached, effort.ramp_steps);
  }
  return text;
}

std::string what_to_do(const MechanicsSettings& settings, const FailedState& state) {
  constexpr double elliptic_tension = 60;  // kPa; an equibiaxial state stays elliptic up to it
  const double stiffness = 6 * (settings.c1 + settings.c2);  // equibiaxial, of the undeformed sheet
  if (settings.edges == Edges::load && std::abs(settings.p) > stiffness) {
    return fmt::format(
        "The load p = {:g} kN/m exceeds the stiffness 6 (c1 + c2) = {:g} kPa of the sheet: "
        "bring mechanics.p nearer to 0 or raise mechanics.c1 and c2.",
        settings.p, stiffness);
  }
  if (state.max_Ta > elliptic_tension) {
    return fmt::format(
        "The tension is above {:g} kPa, where the sheet can lose ellipticity: "
        "lower tension.k_Ta, raise mechanics.c1 and c2, or shorten mechanics.interval.",
        elliptic_tension);
  }
  return "Shorten mechanics.interval, so that the tension changes less between solves; if that does not "
         "help, bring mechanics.p, c1 and c2 nearer to the paper's 10 kN/m, 2 and 6 kPa.";
}

}  // namespace

std::string failure_message(const MechanicsSettings& settings, const FailedState& state,
                            const Effort& effort) {
  const bool loaded = settings.edges == Edges::load;
  const std::string edge =
      loaded ? fmt::format("a {} edge load p = {:g} kN/m",
                           settings.load == Load::follower ? "follower" : "dead", settings.p)
             : "fixed edges";
  return fmt::format(
      "mechanics at t = {:g} t.u.: no equilibrium found for an active tension Ta of {:.4g} to {:.4g} kPa, "
      "{}, "
      "c1 = {:g} and c2 = {:g} kPa.\n"
      "Tried: {}.\n"
      "Reached: residual {:.3g} (wanted {:.3g}), area {:.4g} of the undeformed one, "
      "min J = {:.3g} in element (row {}, column {}).\n{}",
      state.time, state.min_Ta, state.max_Ta, edge, settings.c1, settings.c2, what_was_tried(effort),
      effort.last.residual, settings.tolerance, state.area, state.min_J, state.row, state.column,
      what_to_do(settings, state));
}

std::string no_rest_state_message(const std::string& reason, double time) {
  return fmt::format(
      "mechanics at t = {:g} t.u.: there is no equilibrium to look for, and nothing was iterated.\n{}", time,
      reason);
}

std::string broken_tension_message(double time, int row, int column) {
  return fmt::format(
      "mechanics at t = {:g} t.u.: the active tension is not finite in element (row {}, column {}).\n"
      "The excitation has blown up: lower time.dt.",
      time, row, column);
}

}  // namespace myowave::solver
