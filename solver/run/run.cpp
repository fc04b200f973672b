#include "solver/run/run.hpp"

#include <fmt/format.h>

#include "solver/base/denormals.hpp"
#include "solver/base/error.hpp"
#include "solver/excitation/stability.hpp"
#include "solver/run/device_memory.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/run/stage.hpp"
#include "solver/run/stages.hpp"

namespace myowave::solver {
namespace {

void require_runnable(const Scene& scene, const InitialState& state) {
  if (state.rows != scene.grid.rows || state.columns != scene.grid.columns)
    throw InputError(fmt::format("the initial state is {} x {}, the grid {} x {}", state.rows, state.columns,
                                 scene.grid.rows, scene.grid.columns));
  require_stable_step(scene);
  require_device_memory(scene);
}

// The saved state that a run resumes from, and its stage. Holds a reference to the checkpoint.
struct Saved {
  StateReader reader;
  std::size_t stage = 0;

  Saved(const FoundCheckpoint& checkpoint, const Scene& scene) : reader(checkpoint.state()) {
    reader(stage);
    if (stage > scene.initial.preconditions.size()) throw StateMismatch();
  }
};

std::optional<Saved> saved_of(const RunControl& control, const Scene& scene) {
  return control.resume ? std::optional<Saved>(std::in_place, *control.resume, scene) : std::nullopt;
}

// Takes the place of an initial state that a saved one overwrites.
InitialState blank_state(const Scene& scene) {
  const std::vector<double> zero(static_cast<std::size_t>(scene.grid.rows) * scene.grid.columns);
  return {scene.grid.rows, scene.grid.columns, zero, zero, zero};
}

}  // namespace

InitialState run(const Scene& scene, InitialState state, OutputSink& sink, RunSummary& summary,
                 const RunControl& control) {
  state = run_preconditions(scene, std::move(state), sink, summary, control);
  return run_preconditioned(scene, std::move(state), sink, summary, control);
}

InitialState run_preconditions(const Scene& scene, InitialState state, OutputSink& sink, RunSummary& summary,
                               const RunControl& control) {
  auto saved = saved_of(control, scene);
  if (saved) state = blank_state(scene);
  require_runnable(scene, state);
  const std::vector<Scene> stages = stages_of(scene);
  if (!saved) require_clean_start(stages.front(), state);
  const FlushDenormals flush(control.execution.host);
  const std::size_t preconditions = stages.size() - 1;
  for (std::size_t n = saved ? saved->stage : 0; n < preconditions; ++n) {
    RunSummary own;
    StateReader* const from = saved && saved->stage == n ? &saved->reader : nullptr;
    const RunStage stage{RunStage::Kind::precondition, n, preconditions};
    state = run_stage({stages[n], control, sink, own, summary, stage}, std::move(state), from);
    summary.precondition_s += own.wall_s;
  }
  return state;
}

InitialState run_preconditioned(const Scene& scene, InitialState state, OutputSink& sink, RunSummary& summary,
                                const RunControl& control) {
  const std::size_t preconditions = scene.initial.preconditions.size();
  const RunStage stage{RunStage::Kind::scene, preconditions, preconditions};
  auto saved = saved_of(control, scene);
  const bool resumes = saved && saved->stage == stage.number;
  if (resumes) state = blank_state(scene);
  require_runnable(scene, state);
  const FlushDenormals flush(control.execution.host);
  summary.plan = make_plan(scene);
  if (!resumes)
    for (const auto& text : warnings_of(scene)) warn(sink, summary, text);
  return run_stage({scene, control, sink, summary, summary, stage}, std::move(state),
                   resumes ? &saved->reader : nullptr);
}

}  // namespace myowave::solver
