// An OutputSink that keeps everything, for tests that look at a run from outside.
#pragma once

#include <optional>
#include <vector>

#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave::test {

struct RecordingSink : solver::OutputSink {
  struct ProbeSample {
    double t;
    std::vector<double> values;  // V0, r0, Ta0, V1, ...
  };
  struct TipSample {
    double t;
    std::vector<solver::Tip> tips;
  };
  struct Area {
    double t, total, min, max;
  };

  struct ElementAreas {
    double t;
    std::vector<double> ratios;
  };

  bool keep_fields = false;
  std::vector<ProbeSample> probe_samples;
  std::vector<TipSample> tip_samples;
  std::vector<solver::TipTrajectory> trajectories;
  std::vector<solver::ProbeBeat> beats;
  std::optional<solver::ActivationMaps> activation;
  std::vector<Area> areas;
  std::vector<ElementAreas> element_area_samples;
  double last_frame_t = -1;
  std::vector<double> V, r, Ta, nodes;  // of the last frame

  void probes(double t, std::span<const double> values) override {
    probe_samples.push_back({t, {values.begin(), values.end()}});
  }
  void tips(double t, std::span<const solver::Tip> found) override {
    tip_samples.push_back({t, {found.begin(), found.end()}});
  }
  void trajectory(const solver::TipTrajectory& ended) override { trajectories.push_back(ended); }
  void beat(const solver::ProbeBeat& beat) override { beats.push_back(beat); }
  void area(double t, double total, double min, double max) override {
    areas.push_back({t, total, min, max});
  }
  void fields(const solver::Frame& frame) override {
    last_frame_t = frame.t;
    V.assign(frame.V.begin(), frame.V.end());
    r.assign(frame.r.begin(), frame.r.end());
    Ta.assign(frame.Ta.begin(), frame.Ta.end());
    nodes.assign(frame.nodes.begin(), frame.nodes.end());
  }
  void element_areas(double t, std::span<const double> ratios) override {
    element_area_samples.push_back({t, {ratios.begin(), ratios.end()}});
  }
  void maps(const solver::ActivationMaps& shown) override { activation = shown; }
  bool wants_fields() const override { return keep_fields; }
};

// A run in this process, and all that it showed.
struct RecordedRun {
  solver::InitialState state;  // at the end
  RecordingSink sink;
  solver::RunSummary summary;
};

inline RecordedRun recorded_run(const solver::Scene& scene, const solver::InitialState& initial) {
  RecordedRun result;
  result.sink.keep_fields = true;
  result.state = solver::run(scene, initial, result.sink, result.summary);
  return result;
}

inline RecordedRun recorded_run(const solver::Scene& scene) {
  return recorded_run(scene, solver::make_initial_state(scene));
}

// Time at which a sampled trace crosses `level` upward (or downward) for the first time after
// `from`, by linear interpolation; negative where it does not.
struct Trace {
  std::vector<double> t, value;
  double crossing(double level, bool upward, double from = -1) const {
    for (std::size_t n = 1; n < t.size(); ++n) {
      const double a = value[n - 1], b = value[n];
      if (t[n] > from && (upward ? a < level && b >= level : a >= level && b < level))
        return t[n - 1] + (t[n] - t[n - 1]) * (level - a) / (b - a);
    }
    return -1;
  }
};

inline Trace V_trace(const RecordingSink& sink, std::size_t probe) {
  Trace trace;
  for (const auto& sample : sink.probe_samples) {
    trace.t.push_back(sample.t);
    trace.value.push_back(sample.values[3 * probe]);
  }
  return trace;
}

}  // namespace myowave::test
