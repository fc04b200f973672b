// The whole run: order of a step, sampling, watchers, summary. The order of a step: solver/MODEL.md.
#pragma once

#include <atomic>

#include "solver/base/execution.hpp"
#include "solver/base/run_output.hpp"
#include "solver/run/checkpoint.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Initial state of `rest` and `broken_front`; the other types come from apps (files, cache).
// Errors: InputError for the other types.
InitialState make_initial_state(const Scene&);

// How a run is run. What it computes does not depend on it.
struct RunControl {
  Execution execution{};
  const std::atomic<bool>* stop = nullptr;  // true: the run ends at its next look, by Interrupted
  // Where checkpoints go, at output.checkpoint_every and when the run is asked to stop.
  CheckpointKeeper* checkpoints = nullptr;
  // What the run goes on from, of the same scene; the initial state is not looked at then.
  const FoundCheckpoint* resume = nullptr;
};

// Runs the preconditions and then the scene. `summary` is kept current, so that it tells how far
// the run came when an error leaves this function.
// Returns the final state.
// Errors: InputError (require_stable_step, require_clean_start, sizes that do not fit), NumericalFailure,
// Interrupted, StateMismatch where the checkpoint is none of this scene and program, std::runtime_error where
// the run is to stop and its checkpoint cannot be written.
InitialState run(const Scene&, InitialState, OutputSink&, RunSummary& summary, const RunControl& = {});

// The two parts of it, for scenes that have their preconditions in common: run_preconditioned() from the
// state that run_preconditions() left gives the bits of run(). Of the summary, the first fills
// precondition_s, the steps in parts and their warnings.
InitialState run_preconditions(const Scene&, InitialState, OutputSink&, RunSummary& summary,
                               const RunControl& = {});
InitialState run_preconditioned(const Scene&, InitialState, OutputSink&, RunSummary& summary,
                                const RunControl& = {});

}  // namespace myowave::solver
