// Bounds on V, r and Ta that a run cannot leave, by interval arithmetic.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "solver/run/run.hpp"

namespace myowave::test {

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void cover(double value) {
    // Not-a-number may be anything.
    low = std::isnan(value) ? -std::numeric_limits<double>::infinity() : std::min(low, value);
    high = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(high, value);
  }
  void cover(const Interval& other) { cover(other.low), cover(other.high); }
  bool finite() const { return std::isfinite(low) && std::isfinite(high); }
  double size() const { return std::max(std::abs(low), std::abs(high)); }
};

inline Interval range_of(std::span<const double> values) {
  Interval range;
  for (const double value : values) range.cover(value);
  return range;
}

// Intervals of V, r and Ta that hold at every node after each step: the image of a step by interval
// arithmetic. On a sheet that is rigid, or stretched by s everywhere, a step is
//   V + dt/C_m (k V (V - a)(1 - V) - r V + I_s) + lambda sum (V_neighbour - V)
// with lambda = D dt / (C_m dx^2 s^2) and four neighbours, mirrored at the edges.
class StateBox {
 public:
  explicit StateBox(const solver::InitialState& state)
      : V(range_of(state.V)), r(range_of(state.r)), Ta(range_of(state.Ta)) {}

  // Intervals that hold after each step of one stage of a run; those of the last one hold at its end.
  void advance(const solver::Scene& scene, std::int64_t steps, double stretch) {
    if (!solver::has_tension(scene)) Ta = {0, 0};
    widen(V, rounding(scene) * V.size());
    widen(r, rounding(scene) * r.size());
    widen(Ta, rounding(scene) * Ta.size());
    StateBox seen = *this;
    for (std::int64_t step = 0; step < steps; ++step) {
      one_step(scene, stretch);
      seen.V.cover(V), seen.r.cover(r), seen.Ta.cover(Ta);
    }
    *this = seen;
  }

  bool finite() const { return V.finite() && r.finite() && Ta.finite(); }

  Interval V, r, Ta;

 private:
  // A step has fewer than 16 roundings, those of its parameters included.
  static double rounding(const solver::Scene& scene) {
    return 16 * (scene.precision == solver::Precision::float32 ? 0x1p-24 : 0x1p-53);
  }
  static void widen(Interval& interval, double by) { interval.low -= by, interval.high += by; }

  void one_step(const solver::Scene& scene, double stretch) {
    const auto& e = scene.excitation;
    const double rate = scene.time.dt / e.C_m;
    const double spread = 4 * e.D * rate / std::pow(scene.grid.dx * stretch, 2);
    const Interval old_V = V, old_r = r;
    const double largest = V.size();
    const double terms = (1 + 2 * spread) * largest + rate * e.k * largest * (largest + e.a) * (largest + 1) +
                         rate * r.size() * largest;
    V = extremes_of_a_node(e, rate, spread, old_V, old_r);
    V.low += spread * old_V.low, V.high += spread * old_V.high;
    for (const auto& stimulus : scene.stimuli)
      (stimulus.amplitude < 0 ? V.low : V.high) += rate * stimulus.amplitude;
    widen(V, rounding(scene) * terms);

    r = recovered(scene, old_V, old_r);
    if (!solver::has_tension(scene)) return;
    Ta.cover(scene.tension.k_Ta * old_V.low), Ta.cover(scene.tension.k_Ta * old_V.high);
    widen(Ta, rounding(scene) * Ta.size());
  }

  // Of (1 - spread) V + rate (k V (V - a)(1 - V) - r V): linear in r, a cubic in V.
  static Interval extremes_of_a_node(const solver::ExcitationSettings& e, double rate, double spread,
                                     const Interval& V, const Interval& r) {
    Interval range;
    for (const double r_end : {r.low, r.high}) {
      const double cubic = -rate * e.k, square = rate * e.k * (1 + e.a);
      const double linear = 1 - spread - rate * (e.k * e.a + r_end);
      const auto at = [&](double v) { return ((cubic * v + square) * v + linear) * v; };
      range.cover(at(V.low)), range.cover(at(V.high));
      const double discriminant = square * square - 3 * cubic * linear;
      if (discriminant < 0 || cubic == 0) continue;
      for (const double root : {std::sqrt(discriminant), -std::sqrt(discriminant)}) {
        const double v = (-square + root) / (3 * cubic);
        if (v > V.low && v < V.high) range.cover(at(v));
      }
    }
    return range;
  }

  // r + w (S - r), w = dt (eps + mu1 r / (mu2 + V)), S = k V (1 + b - V): linear in each of w, r and S.
  static Interval recovered(const solver::Scene& scene, const Interval& V, const Interval& r) {
    const auto& e = scene.excitation;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (e.mu2 + V.low <= 0) return {-infinity, infinity};
    Interval w, S, range;
    for (const double r_end : {r.low, r.high})
      for (const double V_end : {V.low, V.high})
        w.cover(scene.time.dt * (e.eps + e.mu1 * r_end / (e.mu2 + V_end)));
    const auto source = [&](double v) { return e.k * v * (1 + e.b - v); };
    S.cover(source(V.low)), S.cover(source(V.high));
    S.cover(source(std::clamp((1 + e.b) / 2, V.low, V.high)));
    for (const double w_end : {w.low, w.high})
      for (const double r_end : {r.low, r.high})
        for (const double S_end : {S.low, S.high}) range.cover(r_end + w_end * (S_end - r_end));
    const double source_terms = e.k * V.size() * (1 + std::abs(e.b) + V.size());
    widen(range, rounding(scene) * (r.size() + w.size() * (source_terms + r.size())));
    return range;
  }
};

}  // namespace myowave::test
