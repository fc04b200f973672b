// The cycle length at points of the sheet.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/run.hpp"

namespace myowave::solver {

// Mean and sample standard deviation, accumulated without storing the samples (Welford).
class RunningStatistics {
 public:
  void add(double value) {
    ++n_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(n_);
    sum_of_squares_ += delta * (value - mean_);
  }
  MeanSd result() const;

 private:
  std::int64_t n_ = 0;
  double mean_ = 0, sum_of_squares_ = 0;
};

// Upstrokes at probes: V crosses 0.5 upward (time by linear interpolation), re-armed below 0.2.
// Intervals whose earlier upstroke is at t >= from count.
class PeriodMeter {
 public:
  static constexpr double threshold = 0.5;
  static constexpr double rearm = 0.2;

  PeriodMeter(std::size_t probes, double from) : probes_(probes), from_(from) {}

  // V of all probes at time t (t.u.), every step in time order.
  void add(double t, std::span<const double> V);
  MeanSd period() const { return periods_.result(); }

 private:
  struct Probe {
    double t = 0, V = 0;
    double upstroke = -1;  // time of the last one
    bool seen = false, armed = false, fired = false;
  };
  std::vector<Probe> probes_;
  double from_;
  RunningStatistics periods_;
};

}  // namespace myowave::solver
