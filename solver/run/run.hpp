// The whole run: order of a step, sampling, watchers, summary. The order of a step: solver/MODEL.md.
#pragma once

#include "solver/base/run_output.hpp"
#include "solver/run/run_control.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

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
