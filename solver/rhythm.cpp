#include "solver/rhythm.hpp"

#include <cmath>

namespace myowave::solver {

MeanSd RunningStatistics::result() const {
  return {mean_, n_ > 1 ? std::sqrt(sum_of_squares_ / static_cast<double>(n_ - 1)) : 0.0, n_};
}

void PeriodMeter::add(double t, std::span<const double> V) {
  for (std::size_t n = 0; n < probes_.size(); ++n) {
    Probe& probe = probes_[n];
    if (probe.seen && probe.armed && probe.V < threshold && V[n] >= threshold) {
      const double upstroke = probe.t + (t - probe.t) * (threshold - probe.V) / (V[n] - probe.V);
      if (probe.fired && probe.upstroke >= from_) periods_.add(upstroke - probe.upstroke);
      probe.upstroke = upstroke;
      probe.fired = true;
      probe.armed = false;
    }
    if (V[n] < rearm) probe.armed = true;
    probe.seen = true;
    probe.t = t;
    probe.V = V[n];
  }
}

}  // namespace myowave::solver
