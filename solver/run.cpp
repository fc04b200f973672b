#include "solver/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "solver/breakup.hpp"
#include "solver/denormals.hpp"
#include "solver/electromechanics.hpp"
#include "solver/error.hpp"
#include "solver/rhythm.hpp"

namespace myowave::solver {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::int64_t steps_of(double duration, double dt) { return std::llround(duration / dt); }

// What is due at which step.
struct Schedule {
  std::int64_t last, fields, tips, probes, watch, mechanics, check;

  static constexpr std::int64_t check_without_mechanics = 100;  // steps between checks for non-finite values

  explicit Schedule(const Scene& scene)
      : last(steps_of(scene.time.t_end, scene.time.dt)),
        fields(every(scene.output.every, scene)),
        tips(every(scene.output.tips_every, scene)),
        probes(every(scene.output.probes_every, scene)),
        watch(every(BreakupWatch::look_every, scene)),
        mechanics(scene.mechanics ? scene.mechanics->interval : 0),
        check(scene.mechanics ? scene.mechanics->interval : check_without_mechanics) {}

  bool due(std::int64_t step, std::int64_t period) const { return step == last || step % period == 0; }

  std::int64_t next(std::int64_t step) const {
    std::int64_t next = last;
    for (const auto period : {fields, tips, probes, watch, check})
      next = std::min(next, (step / period + 1) * period);
    return next;
  }

 private:
  static std::int64_t every(double interval, const Scene& scene) {
    return std::max<std::int64_t>(1, steps_of(interval, scene.time.dt));
  }
};

// The observers of a run: they look, the model does not see them.
class Observers {
 public:
  explicit Observers(const Scene& scene)
      : scene_(scene),
        periods_(scene.output.probes.size(), scene.output.period_from),
        breakup_(scene.initial.type == InitialSettings::Type::broken_front &&
                         scene.initial.preconditions.empty()
                     ? BreakupWatch::settling_time
                     : 0) {}

  void add_tips(int count) { tips_.add(count); }
  void watch(double t, int count, double largest_V, bool more_stimuli) {
    breakup_.look(t, count, largest_V, more_stimuli);
  }

  // V at the probes from step `first` on, all probes of a step together.
  void add_probe_history(std::int64_t first, std::span<const double> history) {
    const std::size_t probes = scene_.output.probes.size();
    if (probes == 0) return;
    for (std::size_t n = 0; n * probes < history.size(); ++n)
      periods_.add(static_cast<double>(first + static_cast<std::int64_t>(n)) * scene_.time.dt,
                   history.subspan(n * probes, probes));
  }

  void add_area(const AreaSample& area) { areas_.push_back(area); }

  // stimulus_period: 0 where there is no periodic stimulus.
  void write(Observables& o, double t, double stimulus_period) const {
    o.period = periods_.period();
    o.tips = tips_.result();
    o.breakup_tu = breakup_.breakup();
    o.death_tu = breakup_.death();
    if (areas_.empty()) return;
    o.area = {areas_[0].ratio, areas_[0].ratio};
    for (const auto& a : areas_)
      o.area = {std::min(o.area->first, a.ratio), std::max(o.area->second, a.ratio)};
    constexpr double last_periods = 10;
    const double from = stimulus_period > 0 ? t - last_periods * stimulus_period : 0;
    o.shortening.reset();
    for (const auto& a : areas_)
      if (a.t >= from && (!o.shortening || a.shortening > o.shortening->first))
        o.shortening = {a.shortening, a.t};
  }

 private:
  const Scene& scene_;
  PeriodMeter periods_;
  BreakupWatch breakup_;
  RunningStatistics tips_;
  std::vector<AreaSample> areas_;  // one a solve
};

// One stage: the scene itself, or a precondition of it (unobserved).
template <class Real>
class Stage {
 public:
  Stage(const Scene& scene, OutputSink& sink, RunSummary& summary, std::string name, bool observed)
      : scene_(scene),
        sink_(sink),
        summary_(summary),
        name_(std::move(name)),
        observed_(observed),
        schedule_(scene),
        observers_(scene) {}

  InitialState run(const InitialState& initial) {
    start_ = Clock::now();
    Sheet sheet(Kokkos::DefaultExecutionSpace{}, scene_, initial, summary_.phases, summary_.mechanics);
    try {
      advance(sheet);
    } catch (...) {
      update_summary(sheet);
      throw;
    }
    update_summary(sheet);
    return sheet.download();
  }

 private:
  using Sheet = Electromechanics<Kokkos::DefaultExecutionSpace, Real>;

  // The order of a step: solve the mechanics and refresh the metric, sample, then the Euler step.
  void advance(Sheet& sheet) {
    for (step_ = 0;;) {
      if (schedule_.mechanics > 0 && step_ % schedule_.mechanics == 0 && sheet.solve_mechanics(t()))
        observers_.add_area(sheet.area());
      if (schedule_.due(step_, schedule_.check)) sheet.check_finite(t());
      if (observed_) sample(sheet);
      report_progress();
      if (step_ == schedule_.last) break;
      const std::int64_t next = schedule_.next(step_);
      sheet.advance(step_, next - step_);
      if (observed_) observers_.add_probe_history(step_, sheet.probe_history());
      step_ = next;
    }
    if (sheet.finish_mechanics(t())) observers_.add_area(sheet.area());
  }

  void sample(Sheet& sheet) {
    const bool tips_due = schedule_.due(step_, schedule_.tips);
    if (tips_due || step_ % schedule_.watch == 0) {
      const auto activity = sheet.find_tips(t());
      tips_ = static_cast<int>(activity.tips.size());
      if (step_ % schedule_.watch == 0)
        observers_.watch(t(), tips_, activity.largest_V, sheet.more_stimuli(t()));
      if (tips_due) {
        observers_.add_tips(tips_);
        output([&] { sink_.tips(t(), activity.tips); });
      }
    }
    if (schedule_.due(step_, schedule_.probes) && !scene_.output.probes.empty())
      output([&] { sink_.probes(t(), sheet.probe_values()); });
    if (!schedule_.due(step_, schedule_.fields)) return;
    output([&] {
      if (sheet.deforms()) {
        const AreaSample& area = sheet.area();
        sink_.area(t(), area.ratio, area.min_ratio, area.max_ratio);
      }
      if (sink_.wants_fields()) write_fields(sheet);
    });
  }

  void write_fields(const Sheet& sheet) {
    const InitialState state = sheet.download();
    const std::vector<double> nodes = sheet.download_nodes();
    const int cells = sheet.deforms() ? scene_.mechanics->cells_per_element : 0;
    sink_.fields({t(), state.rows, state.columns, cells ? (state.rows - 1) / cells : 0,
                  cells ? (state.columns - 1) / cells : 0, state.V, state.r, state.Ta, nodes});
  }

  template <class Action>
  void output(const Action& action) {
    const auto start = Clock::now();
    action();
    summary_.phases.output += seconds_since(start);
  }

  void report_progress() {
    constexpr double every_s = 0.1;
    if (step_ != 0 && step_ != schedule_.last && seconds_since(last_report_) < every_s) return;
    last_report_ = Clock::now();
    sink_.progress(
        {t(), scene_.time.t_end, name_, cell_steps_per_s(), summary_.mechanics.newton_iterations, tips_});
  }

  void update_summary(const Sheet& sheet) {
    summary_.steps = step_;
    summary_.t = t();
    summary_.wall_s = seconds_since(start_);
    summary_.cell_steps_per_s = cell_steps_per_s();
    observers_.write(summary_.observables, t(), sheet.stimulus_period());
  }

  double cell_steps_per_s() const {
    return static_cast<double>(step_) * scene_.grid.rows * scene_.grid.columns / seconds_since(start_);
  }

  double t() const { return static_cast<double>(step_) * scene_.time.dt; }

  const Scene& scene_;
  OutputSink& sink_;
  RunSummary& summary_;
  std::string name_;
  bool observed_;
  Schedule schedule_;
  Observers observers_;
  std::int64_t step_ = 0;
  int tips_ = 0;
  Clock::time_point start_, last_report_;
};

InitialState run_stage(const Scene& scene, const InitialState& state, OutputSink& sink, RunSummary& summary,
                       const std::string& name, bool observed) {
  return scene.precision == Precision::float32
             ? Stage<float>(scene, sink, summary, name, observed).run(state)
             : Stage<double>(scene, sink, summary, name, observed).run(state);
}

void require_stable_dt(const Scene& scene, const char* where) {
  constexpr double undeformed_trace = 2;
  const double bound = largest_stable_dt(scene, undeformed_trace);
  if (scene.time.dt > bound) {
    throw InputError(fmt::format(
        "time.dt = {} is past the stability bound {:.6g} of the undeformed sheet{}, "
        "2 C_m / (8 D / dx^2 + k |1 - a|). Set time.dt to {:.3g} or less, or use a larger grid.dx",
        scene.time.dt, bound, where, 0.99 * bound));
  }
}

Scene precondition_scene(const Scene& scene, const Precondition& precondition) {
  Scene stage = scene;
  stage.excitation = precondition.excitation;
  stage.tension = precondition.tension;
  stage.time.t_end = precondition.duration;
  stage.stimuli.clear();
  stage.output.probes.clear();
  if (!precondition.contraction)
    stage.mechanics.reset();
  else if (stage.mechanics)
    stage.mechanics->contraction = true;
  else
    throw InputError("initial.precondition: contraction = true needs a [mechanics] section");
  return stage;
}

}  // namespace

void require_stable_step(const Scene& scene) {
  require_stable_dt(scene, "");
  for (const auto& precondition : scene.initial.preconditions)
    require_stable_dt(precondition_scene(scene, precondition), " during a precondition");
}

InitialState make_initial_state(const Scene& scene) {
  const int rows = scene.grid.rows, columns = scene.grid.columns;
  const auto nodes = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  InitialState state{rows, columns, std::vector<double>(nodes), std::vector<double>(nodes),
                     std::vector<double>(nodes)};
  switch (scene.initial.type) {
    case InitialSettings::Type::rest:
      return state;
    case InitialSettings::Type::broken_front: {
      const int cx = (columns - 1) / 2 + scene.initial.offset[0];
      const int cy = (rows - 1) / 2 + scene.initial.offset[1];
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
          const auto node = static_cast<std::size_t>(i) * columns + j;
          if (cx - scene.initial.width < j && j <= cx && i <= cy) state.V[node] = 1;
          if (j <= cx - scene.initial.width) state.r[node] = scene.initial.r0;
        }
      return state;
    }
    case InitialSettings::Type::settled_spiral:
    case InitialSettings::Type::file:
      break;
  }
  throw InputError("this initial state comes from a file or from the cache, not from a formula");
}

std::uint64_t memory_bytes(const Scene& scene) {
  const auto nodes =
      static_cast<std::uint64_t>(scene.grid.rows) * static_cast<std::uint64_t>(scene.grid.columns);
  const std::uint64_t real = scene.precision == Precision::float32 ? sizeof(float) : sizeof(double);
  // V twice, r and Ta twice where steps go tile by tile.
  const std::uint64_t copies = scene.mechanics && scene.metric == MetricForm::expanded ? 1 : 2;
  const std::uint64_t state_fields = 2 + copies * (has_tension(scene) ? 2 : 1);
  constexpr std::uint64_t host_fields = 3 + 3;          // initial and sampled V, r, Ta, float64
  constexpr std::uint64_t conservative_fields = 4 + 3;  // weights, scratch of their refresh
  constexpr std::uint64_t expanded_fields = 5;
  std::uint64_t bytes = nodes * (state_fields * real + host_fields * sizeof(double)) +
                        nodes / 4 * sizeof(observe::PhaseSingularity);
  if (!scene.mechanics) return bytes;
  if (scene.metric == MetricForm::conservative) bytes += nodes * conservative_fields * real;
  if (scene.metric == MetricForm::expanded) bytes += nodes * expanded_fields * real;
  const auto cells = static_cast<std::uint64_t>(scene.mechanics->cells_per_element);
  const std::uint64_t unknowns = 2 * (nodes / (cells * cells) + 1);
  // Element matrices and the matrix itself (about 18 entries a row), and the factor: a band as wide as
  // two rows of nodes, at most 256, or with a fill-reducing ordering 31 n log2 n / 4 entries of 12
  // bytes (planar mesh, George 1973).
  const double n = static_cast<double>(unknowns);
  const double band =
      std::min(256.0, 2.0 * (scene.grid.columns - 1) / scene.mechanics->cells_per_element + 5);
  const double factor_bytes = std::max(8 * n * band, 12 * 31.0 / 4 * n * std::log2(n + 2));
  bytes += unknowns * 600 + static_cast<std::uint64_t>(factor_bytes);
  return bytes;
}

std::vector<std::string> model_in_words(const Scene& scene) {
  std::vector<std::string> words;
  const auto& grid = scene.grid;
  words.push_back(fmt::format(
      "Aliev-Panfilov excitation {}, {} x {} nodes, {}, explicit Euler, dt = {} t.u.",
      has_tension(scene) ? fmt::format("with active tension ({} law)", scene.tension.law)
                         : std::string("without tension"),
      grid.rows, grid.columns, scene.precision == Precision::float32 ? "float32" : "float64", scene.time.dt));
  if (!scene.mechanics) {
    words.push_back("rigid sheet: no mechanics, no feedback; 5-point diffusion");
  } else {
    const auto& m = *scene.mechanics;
    words.push_back(fmt::format(
        "incompressible Mooney-Rivlin membrane, {} x {} bilinear elements, {}, {}, solved every {} steps{}",
        (grid.rows - 1) / m.cells_per_element, (grid.columns - 1) / m.cells_per_element,
        m.edges == Edges::fixed
            ? std::string("edges fixed")
            : fmt::format("edge load p = {} kN/m ({})", m.p, m.load == Load::follower ? "follower" : "dead"),
        m.contraction ? "loaded by the active tension"
                      : "no contraction: the active tension does not load it",
        m.interval, m.overlap ? " while the next steps run: nodes and metric are one interval old" : ""));
    switch (scene.metric) {
      case MetricForm::none:
        words.push_back("no feedback: conduction as in the undeformed sheet");
        break;
      case MetricForm::conservative:
        words.push_back(
            "feedback: conduction on the deformed metric, conservative form, held between solves");
        break;
      case MetricForm::expanded:
        words.push_back(
            "feedback: conduction on the deformed metric, expanded form (Eq 24), held between solves");
        break;
    }
  }
  for (const auto& p : scene.initial.preconditions)
    words.push_back(fmt::format("precondition: {} t.u. at mu1 = {}, b = {}, {} contraction", p.duration,
                                p.excitation.mu1, p.excitation.b, p.contraction ? "with" : "without"));
  return words;
}

InitialState run(const Scene& scene, InitialState state, OutputSink& sink, RunSummary& summary) {
  if (state.rows != scene.grid.rows || state.columns != scene.grid.columns)
    throw InputError(fmt::format("the initial state is {} x {}, the grid {} x {}", state.rows, state.columns,
                                 scene.grid.rows, scene.grid.columns));
  require_stable_step(scene);
  flush_denormals();
  summary.model = model_in_words(scene);
  std::size_t number = 0;
  for (const auto& precondition : scene.initial.preconditions) {
    RunSummary unused;
    const std::string name =
        fmt::format("precondition {} of {}", ++number, scene.initial.preconditions.size());
    const auto start = Clock::now();
    state = run_stage(precondition_scene(scene, precondition), state, sink, unused, name, false);
    summary.precondition_s += seconds_since(start);
  }
  return run_stage(scene, state, sink, summary, "run", true);
}

}  // namespace myowave::solver
