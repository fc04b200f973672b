// First break-up of a spiral and the death of all activity, from the tip count and the largest V.
#pragma once

#include <optional>

namespace myowave::solver {

class BreakupWatch {
 public:
  static constexpr double must_last = 2.0;      // t.u.
  static constexpr double settling_time = 5.0;  // t.u., for raw initial data
  static constexpr double quiet_below = 0.05;   // V

  // from: the number of tips then is the reference for later ones. 0, or settling_time if the initial data
  // are a step, which has many false singularities.
  explicit BreakupWatch(double from) : from_(from) {}

  // In time order. `more_stimuli`: a stimulus is on or will be.
  void add_sample(double t, int tips, double largest_V, bool more_stimuli);

  std::optional<double> breakup() const { return breakup_; }
  std::optional<double> death() const { return death_; }

 private:
  double from_;
  std::optional<int> limit_;         // tips that the initial state may have
  std::optional<double> candidate_;  // the count has been above it since
  std::optional<double> breakup_, death_;
};

}  // namespace myowave::solver
