#include "solver/excitation/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/base/error.hpp"
#include "solver/base/root_finding.hpp"

namespace myowave::solver {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// 1/t.u., the steepest fall of the reaction at its two stable states, V = 0 and 1 with r = 0.
double reaction_rate(const ExcitationSettings& e) { return e.k * std::max(std::abs(e.a), std::abs(1 - e.a)); }

// 1/t.u., the steepest rise of the reaction, at V = (1 + a) / 3 with r = 0.
double growth_rate(const ExcitationSettings& e) { return e.k * (1 - e.a + e.a * e.a) / 3; }

// The V beyond which -k V (V - a)(V - one) + push V + current points back to 0. From max(a, one) on it falls
// below 0 once. For V < 0 the same of -V, with a and one = 1 negated.
double turning_point(double k, double a, double one, double push, double current) {
  if (k == 0) return push > 0 || current > 0 ? infinity : 0;
  const double start = std::max({a, one, 0.0});
  const auto points_out = [&](double V) { return V * (k * (V - a) * (V - one) - push) < current; };
  const double end = start + std::sqrt(std::max(0.0, push) / k) + std::cbrt(current / k);
  constexpr double tolerance = 1e-18;  // of the interval: ends the search for a root at 0
  return bisect({start, end}, tolerance * (end - start), points_out).high;
}

// Beyond V > 0 an explicit step of the reaction alone takes V to a larger |V|: k dt / C_m (V - a)(V - 1) = 2.
double blow_up_V(const Scene& scene, double a, double one) {
  const auto& e = scene.excitation;
  const double kappa = e.k * scene.time.dt / e.C_m;
  return kappa > 0 ? 0.5 * (a + one + std::sqrt((one - a) * (one - a) + 8 / kappa)) : infinity;
}

std::string node_text(const InitialState& state, std::size_t node) {
  return fmt::format("at node (row {}, column {}), V = {:.6g}, r = {:.6g}", node / state.columns,
                     node % state.columns, state.V[node], state.r[node]);
}

void require_stable_dt(const Scene& scene, const char* where) {
  const double bound = largest_stable_dt(scene, undeformed_stiffness(scene));
  if (scene.time.dt > bound)
    throw InputError(
        fmt::format("time.dt = {} is past the stability bound {:.6g} of the undeformed sheet{}, "
                    "{}. Set time.dt to {:.3g} or less, or use a larger "
                    "grid.dx",
                    scene.time.dt, bound, where,
                    scene.scheme == Scheme::euler ? "2 C_m / (8 D / dx^2 + k max(a, 1 - a))"
                                                  : "2 C_m / (16/3 D / dx^2 + k (1 - a + a^2) / 3)",
                    0.99 * bound));
  const double eps = scene.excitation.eps;
  if (scene.time.dt * eps > 1)
    throw InputError(
        fmt::format("time.dt = {} is too long for excitation.eps = {}{}: r at rest would turn its sign from "
                    "step to step. Set time.dt to {:.3g} or less",
                    scene.time.dt, eps, where, 0.99 / eps));
}

void require_bearable_stimuli(const Scene& scene, const char* where) {
  if (scene.scheme == Scheme::split) return;  // it returns from any V
  const auto& e = scene.excitation;
  for (std::size_t n = 0; n < scene.stimuli.size(); ++n) {
    const double rise = scene.time.dt * scene.stimuli[n].amplitude / e.C_m;
    const double limit = rise > 0 ? blow_up_V(scene, e.a, 1) : blow_up_V(scene, -e.a, -1);
    if (std::abs(rise) > limit)
      throw InputError(fmt::format(
          "stimulus.{}.amplitude = {} moves V by {:.3g} in one step{}; from {:.3g} on the explicit step "
          "blows "
          "up. Set it to {:.3g} or less in magnitude, or use a smaller time.dt",
          n, scene.stimuli[n].amplitude, rise, where, limit, 0.99 * limit * e.C_m / scene.time.dt));
  }
}

}  // namespace

double undeformed_stiffness(const Scene& scene) { return scene.scheme == Scheme::euler ? 2 : 4.0 / 3; }

double largest_stable_dt(const Scene& scene, double stiffness) {
  const auto& e = scene.excitation;
  const double diffusion = 4 * e.D * stiffness / (scene.grid.dx * scene.grid.dx);
  const double reaction = reaction_rate(e);
  if (scene.scheme == Scheme::euler) return 2 * e.C_m / (diffusion + reaction);
  return 2 * e.C_m / std::max(diffusion + growth_rate(e), reaction);
}

int needed_substeps(double dt, double stable_dt) {
  if (dt <= stable_dt) return 1;
  constexpr double safety = 0.9;  // of the bound: the metric changes until it is next checked
  return static_cast<int>(std::min<double>(most_substeps + 1, std::ceil(dt / (safety * stable_dt))));
}

CleanRange CleanRange::with_margin(const Scene& scene) const {
  const auto& e = scene.excitation;
  const auto beyond = [](double bound) { return margin * std::max(1.0, std::abs(bound)); };
  const double undershoot = metric_form(scene) == MetricForm::none ? 0 : undershoot_of_sheared_front;
  const double pole = e.mu1 > 0 && min_V > -e.mu2 ? -e.mu2 : -infinity;
  return {std::max(min_V - beyond(min_V) - undershoot, pole), max_V + beyond(max_V), min_r - beyond(min_r)};
}

CleanRange clean_range(const Scene& scene, const InitialState& state) {
  const auto& e = scene.excitation;
  double up = 0, down = 0;  // largest, if all stimuli are on at once
  for (const auto& s : scene.stimuli) (s.amplitude > 0 ? up : down) += std::abs(s.amplitude);
  const auto [low_V, high_V] = std::ranges::minmax(state.V);
  const double low_r = std::min(0.0, std::ranges::min(state.r));

  CleanRange range{};
  range.max_V = std::max(high_V, turning_point(e.k, e.a, 1, -low_r, up));
  range.min_V = -std::max(-low_V, turning_point(e.k, -e.a, -1, -low_r, down));
  // r falls below 0 only where k V (V - b - 1) > 0, down to one of the zeros of Eq 22b.
  const double deepest = std::max(
      {0.0, e.k * range.max_V * (range.max_V - e.b - 1), e.k * range.min_V * (range.min_V - e.b - 1)});
  const double slowest = e.mu1 > 0 ? e.eps * (e.mu2 + range.max_V) / e.mu1 : infinity;
  range.min_r = std::min(low_r, -std::min(deepest, slowest));
  return range;
}

void require_stable(const Scene& scene, const char* where) {
  require_stable_dt(scene, where);
  require_bearable_stimuli(scene, where);
}

void require_clean_start(const Scene& scene, const InitialState& state) {
  const auto& e = scene.excitation;
  if (e.mu1 == 0) return;
  // For every V in reach, as long as r_t keeps its sign there.
  const double max_V = clean_range(scene, state).max_V;
  const double runaway = max_V <= e.b + 1 ? -e.eps * (e.mu2 + max_V) / e.mu1 : -infinity;
  for (std::size_t node = 0; node < state.V.size(); ++node) {
    const double V = state.V[node], r = state.r[node];
    if (V <= -e.mu2 && r != 0)
      throw InputError(
          fmt::format("the initial state {} is at or below -excitation.mu2 = {}, the pole of the recovery "
                      "rate eps + mu1 r / (mu2 + V)",
                      node_text(state, node), -e.mu2));
    if (r < runaway && V >= 0)
      throw InputError(
          fmt::format("the initial state {} runs away: r below -eps (mu2 + V) / mu1 falls without end, below "
                      "{:.3g} at every V. Raise r there, or excitation.eps",
                      node_text(state, node), runaway));
    const double rate = e.eps + e.mu1 * r / (e.mu2 + V);
    if (r > 0 && scene.time.dt * rate > 1)
      throw InputError(fmt::format(
          "the initial state {} recovers at the rate eps + mu1 r / (mu2 + V) = {:.3g} per t.u.: one step of "
          "time.dt = {} would throw r past 0. Set time.dt to {:.3g} or less, or use a larger excitation.mu2",
          node_text(state, node), rate, scene.time.dt, 0.99 / rate));
  }
}

std::vector<std::string> warnings_of(const Scene& scene) {
  std::vector<std::string> warnings;
  // Below, an error of dt becomes a tenth of V at 0.9 (`myowave stability --map parameters`). An implicit
  // rule does not overshoot.
  const double fall = scene.time.dt * reaction_rate(scene.excitation) / scene.excitation.C_m;
  if (fall > 1 && scene.scheme == Scheme::euler)
    warnings.push_back(
        fmt::format("time.dt = {} is stable but too long to follow the reaction: k max(a, 1 - a) dt / C_m = "
                    "{:.3g}, and above 1 "
                    "a step goes past the state that V relaxes to. Set time.dt to {:.3g} or less",
                    scene.time.dt, fall, 0.5 * scene.time.dt / fall));
  const double unit_roundoff = 0.5 * (scene.precision == Precision::float32
                                          ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                          : std::numeric_limits<double>::epsilon());
  if (scene.excitation.eps > 0 && scene.time.dt * scene.excitation.eps < unit_roundoff)
    warnings.push_back(fmt::format(
        "time.dt = {} is too short for the precision: at rest a step takes eps dt = {:.3g} of r away, which "
        "is lost "
        "to rounding. Set time.dt to {:.3g} or more",
        scene.time.dt, scene.time.dt * scene.excitation.eps, 10 * unit_roundoff / scene.excitation.eps));
  constexpr double first_k_Ta = 60;  // kPa; V reaches 1
  if (scene.mechanics && scene.mechanics->contraction && scene.tension.k_Ta > first_k_Ta)
    warnings.push_back(fmt::format(
        "tension.k_Ta = {} kPa is above {} kPa: where the tension passes {} kPa the sheet can lose "
        "ellipticity, and its equilibrium then depends on the mesh",
        scene.tension.k_Ta, first_k_Ta, elliptic_tension));
  return warnings;
}

}  // namespace myowave::solver
