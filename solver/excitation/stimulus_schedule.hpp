// When which stimulus is on.
#pragma once

#include <vector>

#include "kernels/tissue/stimulus.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

class StimulusSchedule {
 public:
  // dt: pulses are told apart to within a small part of a step, so that t = step * dt, which is
  // rounded, neither gains nor loses a step.
  StimulusSchedule(const std::vector<Stimulus>&, const GridSettings&, double dt);

  // Those with start + m period <= t < start + m period + duration.
  const std::vector<tissue::ActiveStimulus>& active(double t);

  // Whether any pulse is on at t or begins later.
  bool more_to_come(double t) const;

  // Of the periodic stimulus that ends last; 0 where there is none.
  double last_period() const;

 private:
  std::vector<Stimulus> stimuli_;
  std::vector<tissue::StimulusRegion> regions_;
  std::vector<tissue::ActiveStimulus> active_;
  double tolerance_;
};

}  // namespace myowave::solver
