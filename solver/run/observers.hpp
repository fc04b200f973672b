// The observers of a run. They only read; results do not depend on them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/analysis/breakup.hpp"
#include "solver/analysis/rhythm.hpp"
#include "solver/analysis/tip_trajectory.hpp"
#include "solver/base/area_sample.hpp"
#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

class Observers {
 public:
  // Keeps a reference to the scene.
  explicit Observers(const Scene&);

  // Tips at t, in time order. Assigns them to trajectories, from the time on when the initial data have
  // settled.
  void link(double t, std::span<Tip> tips);
  // Trajectories that ended since the last call.
  std::vector<TipTrajectory> take_ended() { return trajectories_.take_ended(); }

  void add_tips(std::size_t count) { tip_counts_.push_back(static_cast<double>(count)); }
  void watch(double t, int count, double largest_V, bool more_stimuli) {
    breakup_.add_sample(t, count, largest_V, more_stimuli);
  }
  // True once an event that the scene stops on has occurred.
  bool wants_end() const;

  // V at the probes from step `first` on, all probes of a step together.
  void add_probe_history(std::int64_t first, std::span<const double> history);

  // Beats completed since the last call.
  std::vector<ProbeBeat> take_beats() { return beats_.take(); }
  // Call after the last sample.
  void finish() {
    trajectories_.finish();
    beats_.finish();
  }

  void add_area(const AreaSample& area) { areas_.push_back(area); }

  template <class Archive>
  void state(Archive& archive) {
    archive(beats_, breakup_, trajectories_, tip_counts_, areas_);
  }

  // stimulus_period: 0 if there is no periodic stimulus.
  void write(Observables&, double t, double stimulus_period) const;

 private:
  const Scene& scene_;
  BeatRecorder beats_;
  double settled_;  // t.u.
  BreakupWatch breakup_;
  TipTrajectories trajectories_;
  std::vector<double> tip_counts_;
  std::vector<AreaSample> areas_;  // one per solve
};

}  // namespace myowave::solver
