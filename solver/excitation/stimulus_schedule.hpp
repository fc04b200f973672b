// Which stimuli are on at which time.
#pragma once

#include <vector>

#include "kernels/tissue/stimulus.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

class StimulusSchedule {
 public:
  // dt: starts and ends of pulses have a tolerance of a small fraction of a step, so that the rounding of
  // t = step * dt neither adds nor drops a step.
  StimulusSchedule(const std::vector<Stimulus>&, const GridSettings&, double dt);

  // Those with start + m period <= t < start + m period + duration.
  const std::vector<tissue::ActiveStimulus>& active(double t);

  // Whether any pulse is on at t or starts later.
  bool more_to_come(double t) const;

  // Of the periodic stimulus that ends last; 0 if there is none.
  double last_period() const;

 private:
  std::vector<Stimulus> stimuli_;
  std::vector<tissue::StimulusRegion> regions_;
  std::vector<tissue::ActiveStimulus> active_;
  double tolerance_;
};

}  // namespace myowave::solver
