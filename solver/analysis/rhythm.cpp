#include "solver/analysis/rhythm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace myowave::solver {

std::optional<Beat> BeatDetector::add(double t, double V) {
  std::optional<Beat> complete;
  const auto crossing = [&](double level) { return t_ + (t - t_) * (level - V_) / (V - V_); };
  const auto rises_through = [&](double level) { return seen_ && V_ < level && V >= level; };
  const auto falls_through = [&](double level) { return seen_ && V_ >= level && V < level; };

  if (rises_through(BeatLevels::apd)) rise_ = crossing(BeatLevels::apd);
  if (armed_ && rises_through(BeatLevels::upstroke)) complete = begin_beat(crossing(BeatLevels::upstroke));
  if (beat_) {
    beat_peak_ = std::max(beat_peak_, V);
    const double level = beat_peak_ - BeatLevels::repolarisation * (beat_peak_ - beat_rest_);
    if (std::isnan(beat_->apd90) && falls_through(level)) beat_->apd90 = crossing(level) - beat_->upstroke;
    if (std::isnan(beat_->apd) && falls_through(BeatLevels::apd))
      beat_->apd = crossing(BeatLevels::apd) - beat_rise_;
  }
  if (V < BeatLevels::rearm) armed_ = true;
  lowest_ = seen_ ? std::min(lowest_, V) : V;
  seen_ = true;
  t_ = t;
  V_ = V;
  return complete;
}

std::optional<Beat> BeatDetector::begin_beat(double upstroke) {
  std::optional<Beat> before = beat_;
  if (before) {
    before->period = upstroke - before->upstroke;
    before->di = before->period - before->apd90;
  }
  beat_ = {.upstroke = upstroke};
  beat_rise_ = std::exchange(rise_, unknown);
  beat_rest_ = beat_peak_ = lowest_;
  lowest_ = BeatLevels::upstroke;
  armed_ = false;
  return before;
}

void BeatRecorder::add(double t, std::span<const double> V) {
  for (std::size_t n = 0; n < probes_.size(); ++n)
    if (const auto beat = probes_[n].add(t, V[n])) record(n, *beat);
}

void BeatRecorder::finish() {
  for (std::size_t n = 0; n < probes_.size(); ++n)
    if (probes_[n].last()) record(n, *probes_[n].last());
}

void BeatRecorder::record(std::size_t probe, const Beat& beat) {
  complete_.push_back({probe, beat});
  if (beat.upstroke < from_) return;
  const auto add_known = [](RunningStatistics& statistics, double value) {
    if (!std::isnan(value)) statistics.add(value);
  };
  add_known(period_, beat.period);
  add_known(apd_, beat.apd);
  add_known(apd90_, beat.apd90);
}

}  // namespace myowave::solver
