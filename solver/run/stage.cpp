#include "solver/run/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "solver/analysis/conduction_velocity.hpp"
#include "solver/base/error.hpp"
#include "solver/coupling/electromechanics.hpp"
#include "solver/excitation/stability.hpp"
#include "solver/run/observers.hpp"
#include "solver/run/schedule.hpp"

namespace myowave::solver {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr const char* what_to_do =
    "Use a smaller time.dt, or check the stimulus amplitude, excitation.k and mu2";

// A precondition is not observed.
template <class Real>
class Stage {
 public:
  explicit Stage(const StageContext& context)
      : scene_(context.scene),
        control_(context.control),
        sink_(context.sink),
        summary_(context.summary),
        whole_(context.whole),
        stage_(context.stage),
        schedule_(context.scene),
        observers_(context.scene) {}

  // Starts from the initial state, or from the saved one.
  InitialState run(InitialState initial, StateReader* saved) {
    start_ = Clock::now();
    Sheet sheet(control_.execution, scene_, initial, summary_.phases, summary_.mechanics);
    initial = {};  // the sheet has its own
    if (saved) load(sheet, *saved);
    saved_step_ = step_;
    try {
      if (!saved) {
        require_valid(sheet.check_state(0, 0));
        arrive(sheet);
      }
      advance(sheet);
    } catch (...) {
      end(sheet);
      throw;
    }
    end(sheet);
    return sheet.download();
  }

 private:
  using Sheet = Electromechanics<Kokkos::DefaultExecutionSpace, Real>;

  // Everything except the sheet.
  template <class Archive>
  void state(Archive& archive) {
    archive(step_, schedule_.last, substeps_, substepped_steps_, largest_substeps_, last_problem_,
            warned_of_tension_, warned_of_ellipticity_, tips_, observers_, summary_.phases,
            summary_.mechanics, whole_.warnings, whole_.substepped_steps, whole_.largest_substeps,
            whole_.precondition_s);
  }

  void advance(Sheet& sheet) {
    while (step_ != schedule_.last) {
      save_if_due(sheet);
      const std::int64_t first = step_;
      step_to(sheet, schedule_.next(step_));
      if (observed()) observe([&] { observers_.add_probe_history(first, sheet.probe_history()); });
      show_beats();
      arrive(sheet);
    }
  }

  // The order at a step: solve the mechanics and refresh the metric, then sample; the Euler step comes after.
  void arrive(Sheet& sheet) {
    if (schedule_.mechanics > 0 && step_ % schedule_.mechanics == 0) {
      sheet.solve_mechanics(t());
      observers_.add_area(sheet.area());
    }
    check_tension(sheet);
    check_ellipticity();
    if (observed()) sample(sheet);
    report_progress();
  }

  void save_if_due(Sheet& sheet) {
    const bool stop = control_.stop && *control_.stop;
    const double every = scene_.output.checkpoint_every;
    const bool due = every > 0 && static_cast<double>(step_ - saved_step_) * scene_.time.dt >= every - 1e-9;
    if (control_.checkpoints && (stop || due)) save(sheet, stop);
    if (stop) throw Interrupted(fmt::format("{}: stopped at t = {:.6g} t.u.", stage_text(stage_), t()));
  }

  // If a checkpoint cannot be written, the run continues: the previous one is still there, and the disk may
  // have room for the next.
  void save(Sheet& sheet, bool stop) {
    StateWriter writer;
    writer(stage_.number, seconds_since(start_) + wall_before_);
    state(writer);
    sheet.save(writer);
    output([&] {
      try {
        control_.checkpoints->keep(writer, step_, t(), sink_.mark());
      } catch (const std::runtime_error& error) {
        if (stop) throw;
        warn(sink_, whole_, fmt::format("t = {:.6g} t.u.: no checkpoint: {}", t(), error.what()));
      }
    });
    saved_step_ = step_;
  }

  void load(Sheet& sheet, StateReader& saved) {
    saved(wall_before_);
    state(saved);
    sheet.load(saved, t());
    if (!saved.at_end()) throw StateMismatch();
  }

  void step_to(Sheet& sheet, std::int64_t next) {
    if (scene_.on_unstable == OnUnstable::substep) return substep_to(sheet, next);
    sheet.advance(step_, next - step_);
    step_ = next;
    if (schedule_.due(step_, schedule_.check)) require_valid(sheet.check_state(t(), scene_.time.dt));
  }

  // Takes substeps if dt exceeds the bound of the metric. If the state is invalid then, repeats the steps
  // from their start with twice as many substeps. The next steps try half as many.
  void substep_to(Sheet& sheet, std::int64_t next) {
    const double dt = scene_.time.dt;
    sheet.keep();
    int parts = std::max(needed_substeps(dt, sheet.stable_dt()), substeps_ / 2);
    for (;; parts *= 2) {
      if (parts > most_substeps)
        throw NumericalFailure(fmt::format(
            "t = {:.6g} t.u.: no valid state was found with up to {} substeps of dt = {}; the bound of "
            "the metric is "
            "{:.3g}{}. {}",
            t(), most_substeps, dt, sheet.stable_dt(),
            last_problem_.empty() ? "" : "; the last problem: " + last_problem_, what_to_do));
      sheet.advance(step_, next - step_, parts);
      const auto problem = sheet.check_state(static_cast<double>(next) * dt, dt / parts);
      if (!problem) break;
      last_problem_ = *problem;
      sheet.go_back();
    }
    if (parts > 1) {
      substepped_steps_ += next - step_;
      largest_substeps_ = std::max(largest_substeps_, parts);
    }
    substeps_ = parts;
    last_problem_.clear();
    step_ = next;
  }

  void require_valid(const std::optional<std::string>& problem) const {
    if (problem)
      throw NumericalFailure(
          fmt::format("{}. {}; accuracy.on_unstable = \"substep\" takes smaller steps where they are needed",
                      *problem, what_to_do));
  }

  void check_tension(const Sheet& sheet) {
    if (warned_of_tension_ || !sheet.deforms()) return;
    const double largest = sheet.largest_tension();
    if (largest <= elliptic_tension) return;
    warned_of_tension_ = true;
    warn(sink_, whole_,
         fmt::format("t = {:.6g} t.u.: the active tension has reached {:.4g} kPa; above {} kPa the sheet can "
                     "lose ellipticity",
                     t(), largest, elliptic_tension));
  }

  void check_ellipticity() {
    if (warned_of_ellipticity_ || summary_.mechanics.not_elliptic == 0) return;
    warned_of_ellipticity_ = true;
    warn(sink_, whole_,
         fmt::format("t = {:.6g} t.u.: a part of the sheet has lost ellipticity: its folds there depend on "
                     "the mesh",
                     t()));
  }

  void sample(Sheet& sheet) {
    sample_tips(sheet);
    if (schedule_.due(step_, schedule_.probes) && !scene_.output.probes.empty()) {
      std::vector<double> values;
      observe([&] { values = sheet.probe_values(); });
      output([&] { sink_.probes(t(), values); });
    }
    if (scene_.output.maps && schedule_.due(step_, schedule_.maps)) sheet.sample_activation(t());
    if (!schedule_.fields_due(step_)) return;
    output([&] {
      if (sheet.deforms()) {
        const AreaSample& area = sheet.area();
        sink_.area(t(), area.ratio, area.min_ratio, area.max_ratio);
      }
      if (has_element_areas(scene_)) sink_.element_areas(t(), sheet.element_area_ratios());
      if (sink_.wants_fields()) write_fields(sheet);
    });
  }

  void show_beats() {
    for (const auto& beat : observers_.take_beats()) output([&] { sink_.beat(beat); });
  }

  void sample_tips(Sheet& sheet) {
    const bool watched = step_ % schedule_.watch == 0;
    if (!watched && !schedule_.due(step_, schedule_.tips)) return;
    auto activity = sheet.find_tips(t());
    tips_ = static_cast<int>(activity.tips.size());
    observe([&] {
      observers_.link(t(), activity.tips);
      if (watched) observers_.watch(t(), tips_, activity.largest_V, sheet.more_stimuli(t()));
    });
    if (watched && observers_.wants_end() && step_ != schedule_.last) {
      require_valid(sheet.check_state(t(), scene_.time.dt));  // as at every end
      schedule_.last = step_;
    }
    show_ended_trajectories();
    if (!schedule_.due(step_, schedule_.tips)) return;
    observers_.add_tips(activity.tips.size());
    output([&] { sink_.tips(t(), activity.tips); });
  }

  void show_ended_trajectories() {
    for (const auto& ended : observers_.take_ended()) output([&] { sink_.trajectory(ended); });
  }

  void show_maps(ActivationMaps maps) {
    observe([&] {
      maps.conduction_velocity = conduction_velocity(maps.rows, maps.columns, maps.dx, maps.activation);
    });
    summary_.observables.conduction_velocity = quartiles(maps.conduction_velocity);
    output([&] { sink_.maps(maps); });
  }

  void write_fields(const Sheet& sheet) {
    const InitialState state = sheet.download();
    const std::vector<double> nodes = sheet.download_nodes();
    const int cells = sheet.deforms() ? scene_.mechanics->cells_per_element : 0;
    sink_.fields({t(), state.rows, state.columns, cells ? (state.rows - 1) / cells : 0,
                  cells ? (state.columns - 1) / cells : 0, state.V, state.r, state.Ta, nodes});
  }

  template <class Action>
  void observe(const Action& action) {
    add_time_of(action, summary_.phases.observe);
  }
  template <class Action>
  void output(const Action& action) {
    add_time_of(action, summary_.phases.output);
  }
  template <class Action>
  static void add_time_of(const Action& action, double& seconds) {
    const auto start = Clock::now();
    action();
    seconds += seconds_since(start);
  }

  void report_progress() {
    constexpr double every_s = 0.1;
    if (step_ != 0 && step_ != schedule_.last && seconds_since(last_report_) < every_s) return;
    last_report_ = Clock::now();
    sink_.progress(
        {t(), scene_.time.t_end, stage_, cell_steps_per_s(), summary_.mechanics.newton_iterations, tips_});
  }

  // The summary first, so that it is complete even if an output fails.
  void end(const Sheet& sheet) {
    observe([&] { observers_.finish(); });
    update_summary(sheet);
    show_beats();
    if (observed()) show_ended_trajectories();
    if (scene_.output.maps) show_maps(sheet.activation_maps());
  }

  void update_summary(const Sheet& sheet) {
    summary_.steps = step_;
    summary_.t = t();
    summary_.wall_s = seconds_since(start_) + wall_before_;
    summary_.cell_steps_per_s = cell_steps_per_s();
    observe([&] { observers_.write(summary_.observables, t(), sheet.stimulus_period()); });
    if (substepped_steps_ == 0) return;
    whole_.substepped_steps += substepped_steps_;
    whole_.largest_substeps = std::max<std::int64_t>(whole_.largest_substeps, largest_substeps_);
    warn(sink_, whole_,
         fmt::format("{}: {} of {} steps were divided into up to {} substeps, because dt = {} was unstable",
                     stage_text(stage_), substepped_steps_, step_, largest_substeps_, scene_.time.dt));
  }

  double cell_steps_per_s() const {
    return static_cast<double>(step_) * scene_.grid.rows * scene_.grid.columns /
           (seconds_since(start_) + wall_before_);
  }

  bool observed() const { return stage_.kind == RunStage::Kind::scene; }

  double t() const { return static_cast<double>(step_) * scene_.time.dt; }

  const Scene& scene_;
  const RunControl& control_;
  OutputSink& sink_;
  RunSummary& summary_;
  RunSummary& whole_;
  RunStage stage_;
  Schedule schedule_;
  Observers observers_;
  std::int64_t step_ = 0;
  int substeps_ = 1;  // at the last call of substep_to()
  std::int64_t substepped_steps_ = 0;
  int largest_substeps_ = 1;
  std::string last_problem_;
  bool warned_of_tension_ = false, warned_of_ellipticity_ = false;
  int tips_ = 0;
  std::int64_t saved_step_ = 0;  // step of the last checkpoint
  double wall_before_ = 0;       // s, before the run was resumed
  Clock::time_point start_, last_report_;
};

}  // namespace

void warn(OutputSink& sink, RunSummary& summary, const std::string& text) {
  summary.warnings.push_back(text);
  sink.warning(text);
}

InitialState run_stage(const StageContext& context, InitialState state, StateReader* saved) {
  return context.scene.precision == Precision::float32 ? Stage<float>(context).run(std::move(state), saved)
                                                       : Stage<double>(context).run(std::move(state), saved);
}

}  // namespace myowave::solver
