// Beats at points of the sheet: cycle lengths, action potential durations, diastolic intervals.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "solver/analysis/statistics.hpp"
#include "solver/base/beat.hpp"

namespace myowave::solver {

// The action potentials at one point, from V in time order. Every crossing is interpolated linearly.
class BeatDetector {
 public:
  // V at time t (t.u.). Returns the beat that an upstroke ends: the one before it.
  std::optional<Beat> add(double t, double V);
  // The last beat, without a next upstroke: its period and diastolic interval are unknown.
  const std::optional<Beat>& last() const { return beat_; }

 private:
  std::optional<Beat> begin_beat(double upstroke);

  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double t_ = 0, V_ = 0;
  bool seen_ = false, armed_ = false;
  double rise_ = unknown;  // time of crossing apd_level, for the next upstroke
  double lowest_ = 0;      // V since the last upstroke
  std::optional<Beat> beat_;
  double beat_rise_ = unknown, beat_rest_ = 0, beat_peak_ = 0;
};

// The beats at probes, and their statistics over those whose upstroke is at t >= from.
class BeatRecorder {
 public:
  BeatRecorder(std::size_t probes, double from) : probes_(probes), from_(from) {}

  // V of all probes at time t (t.u.), every step in time order.
  void add(double t, std::span<const double> V);
  // Call once, after the last step: adds the last beats, whose periods are unknown.
  void finish();
  // Beats that were completed, by the next upstroke or finish(), since the last call.
  std::vector<ProbeBeat> take() { return std::exchange(complete_, {}); }

  template <class Archive>
  void state(Archive& archive) {
    archive(probes_, complete_, period_, apd_, apd90_);
  }

  MeanSd period() const { return period_.result(); }
  MeanSd apd() const { return apd_.result(); }
  MeanSd apd90() const { return apd90_.result(); }

 private:
  void record(std::size_t probe, const Beat&);

  std::vector<BeatDetector> probes_;
  double from_;
  std::vector<ProbeBeat> complete_;
  RunningStatistics period_, apd_, apd90_;
};

}  // namespace myowave::solver
