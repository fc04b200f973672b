#include "apps/tradeoff/tradeoff_measure.hpp"

#include <unistd.h>

#include <cmath>
#include <numeric>
#include <utility>

#include "apps/base/progress_line.hpp"
#include "apps/base/signals.hpp"
#include "apps/input/initial_state.hpp"
#include "apps/input/resample.hpp"
#include "apps/results/observable_table.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave::apps {
namespace {

solver::RunControl stoppable() { return {.stop = &stop_requested()}; }

// Without a terminal, one line per run.
bool is_quiet() { return isatty(STDERR_FILENO) == 0; }

// First action potential at each probe.
class FirstBeats final : public solver::OutputSink {
 public:
  void beat(const solver::ProbeBeat& seen) override { beats_.try_emplace(seen.probe, seen.beat); }
  const solver::Beat* at(std::size_t probe) const {
    const auto found = beats_.find(probe);
    return found == beats_.end() ? nullptr : &found->second;
  }

 private:
  std::map<std::size_t, solver::Beat> beats_;
};

class Progress final : public solver::OutputSink {
 public:
  explicit Progress(double ms_per_tu) : line_(ms_per_tu, is_quiet()) {}
  void progress(const solver::Progress& progress) override { line_.show(progress); }

 private:
  ProgressLine line_;
};

class SceneRecorder final : public solver::OutputSink {
 public:
  SceneRecorder(const solver::Scene& scene, const Sampling& sampling, std::string name)
      : dt_(scene.time.dt),
        solve_every_(scene.mechanics ? scene.mechanics->interval * dt_ : 0),
        half_(sampling.half),
        line_(scene.time.ms_per_tu, is_quiet(), std::move(name)) {}

  void tips(double t, std::span<const solver::Tip> found) override {
    t_ = t;
    measures.tips.assign(found.begin(), found.end());
  }
  bool wants_fields() const override { return std::abs(t_ - half_) < 0.5 * dt_; }
  void fields(const solver::Frame& frame) override { measures.V_half.assign(frame.V.begin(), frame.V.end()); }
  // The area of the last solve stands until the next one.
  void area(double t, double total, double, double) override {
    const double solved = std::floor(t / solve_every_ + 1e-6) * solve_every_;
    auto& [times, values] = measures.area;
    if (!times.empty() && solved < times.back() + 0.5 * dt_) return;
    times.push_back(solved);
    values.push_back(total);
  }
  void progress(const solver::Progress& progress) override { line_.show(progress); }

  Measures measures;

 private:
  double dt_, solve_every_, half_, t_ = 0;
  ProgressLine line_;
};

solver::Scene strip_of(const solver::Scene& scene) {
  constexpr double length = 120, stimulated = 3, t_end = 400;
  const double dx = scene.grid.dx;
  solver::Scene strip;
  strip.name = "plane wave";
  strip.grid = {3, 1 + static_cast<int>(std::lround(length / dx)), dx};
  strip.time.dt = scene.time.dt;
  strip.time.t_end = t_end;
  strip.time.stop_on.death = true;
  strip.excitation = scene.excitation;
  strip.precision = scene.precision;
  strip.scheme = scene.scheme;
  strip.on_unstable = scene.on_unstable;
  solver::Stimulus stimulus;
  stimulus.amplitude = 1;  // more throws long steps past V = 1, from where they do not come back
  stimulus.shape = solver::Stimulus::Shape::block;
  stimulus.columns = {0, static_cast<int>(stimulated / dx)};
  stimulus.rows = {0, 2};
  strip.stimuli = {stimulus};
  const int last = strip.grid.columns - 1;
  strip.output.probes = {{1, last / 3}, {1, last / 2}, {1, 2 * last / 3}};
  strip.output.every = strip.output.tips_every = strip.output.probes_every = t_end;
  strip.output.watch_every = 1;
  strip.output.tension = false;
  strip.output.period_from = 0;
  return strip;
}

solver::InitialState on_grid(const solver::InitialState& state, const solver::GridSettings& from,
                             const solver::GridSettings& to) {
  if (from.rows == to.rows && from.columns == to.columns) return state;
  return {to.rows, to.columns, resample(state.V, from, to), resample(state.r, from, to),
          resample(state.Ta, from, to)};
}

void add_numbers(const solver::Observables& seen, Measures& measures) {
  auto& numbers = measures.numbers;
  for (const ObservableRow& row : observable_table()) {
    if (row.error.kind == ObservableError::Kind::none) continue;
    if (const auto value = row.get(seen); value.is_number())
      numbers[std::string(row.error.name)] = value.get<double>();
  }
  const auto& areas = measures.area.value;
  if (!areas.empty())
    numbers["area_mean"] =
        std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(areas.size());
}

}  // namespace

Sampling sampling_of(const solver::Scene& scene) {
  const double end = scene.time.t_end;
  const double every = end >= 4 ? 1 : 0.2;
  return {every, every * std::round(0.5 * end / every), end};
}

Measures measure_plane_wave(const solver::Scene& scene) {
  const solver::Scene strip = strip_of(scene);
  FirstBeats sink;
  solver::RunSummary summary;
  solver::run(strip, solver::make_initial_state(strip), sink, summary, stoppable());
  const solver::Beat *third = sink.at(0), *middle = sink.at(1), *two_thirds = sink.at(2);
  Measures measures;
  if (third == nullptr || middle == nullptr || two_thirds == nullptr) return measures;
  const int columns = strip.output.probes[2][1] - strip.output.probes[0][1];
  measures.numbers["cv"] = columns * strip.grid.dx / (two_thirds->upstroke - third->upstroke);
  if (std::isfinite(middle->apd)) measures.numbers["apd"] = middle->apd;
  return measures;
}

solver::InitialState start_of(const solver::Scene& scene) {
  Progress sink(scene.time.ms_per_tu);
  solver::RunSummary summary;
  return solver::run_preconditions(scene, resolve_initial_state(scene, sink), sink, summary, stoppable());
}

MeasuredRun measure_scene(solver::Scene scene, const solver::InitialState& start,
                          const solver::GridSettings& own, const Sampling& sampling,
                          const std::string& name) {
  solver::OutputSettings& output = scene.output;
  output.every = output.tips_every = output.probes_every = sampling.every;
  output.from = 0;
  output.frames = output.fields = output.element_areas = output.maps = false;
  output.tension = solver::contracts(scene);
  SceneRecorder recorder(scene, sampling, name);
  solver::RunSummary summary;
  const solver::InitialState end =
      solver::run_preconditioned(scene, on_grid(start, own, scene.grid), recorder, summary, stoppable());
  MeasuredRun run{std::move(recorder.measures), summary.wall_s, summary.cell_steps_per_s};
  Measures& measures = run.measures;
  if (!measures.V_half.empty()) measures.V_half = resample(measures.V_half, scene.grid, own);
  // A run that ends early has nothing to compare at the end.
  if (std::abs(summary.t - sampling.end) < scene.time.dt)
    measures.V_end = resample(end.V, scene.grid, own);
  else
    measures.tips.clear();
  add_numbers(summary.observables, measures);
  return run;
}

}  // namespace myowave::apps
