#include "apps/results/estimate.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include "apps/input/initial_state.hpp"
#include "apps/results/run_folder.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave::apps {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Waves have their usual number and form after about one rotation of a spiral, 27 t.u. Large sheets run fewer
// node steps.
constexpr double start_tu = 40, start_node_steps = 3e8;
constexpr double watched_s = 1.3;

double start_of(double duration, const solver::Scene& scene) {
  const double nodes = static_cast<double>(scene.grid.rows) * scene.grid.columns;
  return std::min({duration, start_tu, std::max(1.0, start_node_steps / nodes) * scene.time.dt});
}

struct Enough {};

// Times one stage of a run, and stops the run after budget_s.
class StageClock final : public solver::OutputSink {
 public:
  StageClock(solver::RunStage::Kind stage, solver::OutputSink& outputs,
             double budget_s = std::numeric_limits<double>::infinity())
      : stage_(stage), outputs_(outputs), budget_s_(budget_s), start_(Clock::now()) {}

  // The time from the start of the clock to the end of the stage at t_end.
  double extrapolated(double t_end) const {
    return last_.t > 0 ? first_s_ + (last_s_ - first_s_) * t_end / last_.t : last_s_;
  }

  void fields(const solver::Frame& frame) override { outputs_.fields(frame); }
  void probes(double t, std::span<const double> values) override { outputs_.probes(t, values); }
  void tips(double t, std::span<const solver::Tip> tips) override { outputs_.tips(t, tips); }
  void trajectory(const solver::TipTrajectory& one) override { outputs_.trajectory(one); }
  void area(double t, double total, double min, double max) override { outputs_.area(t, total, min, max); }
  void element_areas(double t, std::span<const double> ratios) override { outputs_.element_areas(t, ratios); }
  void beat(const solver::ProbeBeat& beat) override { outputs_.beat(beat); }
  void maps(const solver::ActivationMaps& maps) override { outputs_.maps(maps); }
  bool wants_fields() const override { return outputs_.wants_fields(); }

  // The first call is at t = 0, after the set-up, which is done only once.
  void progress(const solver::Progress& now) override {
    if (now.stage.kind != stage_) return;
    last_ = now;
    last_s_ = seconds_since(start_);
    if (now.t == 0) first_s_ = last_s_;
    if (now.t > 0 && last_s_ > budget_s_) throw Enough();
  }

 private:
  solver::RunStage::Kind stage_;
  solver::OutputSink& outputs_;
  double budget_s_;
  Clock::time_point start_;
  solver::Progress last_;
  double first_s_ = 0, last_s_ = 0;
};

class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() / fmt::format("myowave_check_{}", getpid())) {}
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Seconds of the scene to t_end, extrapolated from its start. Advances the state by that start.
double seconds_of_start(solver::Scene scene, solver::InitialState& state) {
  const double t_end = std::exchange(scene.time.t_end, start_of(scene.time.t_end, scene));
  solver::OutputSink nowhere;
  solver::RunSummary summary;
  StageClock clock(solver::RunStage::Kind::scene, nowhere);
  state = solver::run(scene, std::move(state), clock, summary);
  return clock.extrapolated(t_end);
}

double seconds_of_precondition(solver::Scene scene, const solver::Precondition& one,
                               solver::InitialState& state) {
  scene.time.t_end = 0;
  scene.initial.preconditions = {one};
  scene.initial.preconditions[0].duration = start_of(one.duration, scene);
  solver::OutputSink nowhere;
  solver::RunSummary summary;
  StageClock clock(solver::RunStage::Kind::precondition, nowhere);
  state = solver::run(scene, std::move(state), clock, summary);
  return clock.extrapolated(one.duration);
}

double seconds_with_outputs(const solver::Scene& scene, solver::InitialState state) {
  const TemporaryFolder temporary;
  RunFolder folder(temporary.path(), scene, true, true);
  solver::RunSummary summary;
  StageClock clock(solver::RunStage::Kind::scene, folder, watched_s);
  try {
    solver::run(scene, std::move(state), clock, summary);
  } catch (const Enough&) {
    // The clock ran for long enough.
  }
  return clock.extrapolated(scene.time.t_end);
}

}  // namespace

Estimate estimate(const solver::Scene& given) {
  Estimate result;
  solver::Scene scene = given;
  solver::InitialState state;
  if (const auto settling = spiral_to_settle(scene)) {
    solver::InitialState other_sheet = solver::make_initial_state(*settling);
    result.settling_s = seconds_of_start(*settling, other_sheet);
    scene.initial = settling->initial;
    state = solver::make_initial_state(scene);
  } else {
    solver::OutputSink nowhere;
    state = resolve_initial_state(scene, nowhere);
  }
  scene.initial.preconditions.clear();
  for (const auto& one : given.initial.preconditions)
    result.preconditions_s += seconds_of_precondition(scene, one, state);
  if (given.initial.preconditions.empty()) seconds_of_start(scene, state);
  result.scene_s = seconds_with_outputs(scene, std::move(state));
  return result;
}

}  // namespace myowave::apps
