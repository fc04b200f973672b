// A whole run: its preconditions, then the scene.
#pragma once

#include "solver/base/run_output.hpp"
#include "solver/run/run_control.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Runs the preconditions and then the scene. `summary` is kept current, so that it shows how far the run got
// if this function throws. Returns the final state. Errors: InputError (require_stable_step,
// require_clean_start, wrong sizes), NumericalFailure, Interrupted, StateMismatch if the checkpoint is of
// another scene or program version, std::runtime_error if the run was asked to stop and its checkpoint cannot
// be written.
InitialState run(const Scene&, InitialState, OutputSink&, RunSummary& summary, const RunControl& = {});

// The two parts of run(), for scenes that share their preconditions: run_preconditioned() from the state that
// run_preconditions() returned is bitwise identical to run(). Of the summary, run_preconditions() fills
// precondition_s, the substeps and the warnings about them.
InitialState run_preconditions(const Scene&, InitialState, OutputSink&, RunSummary& summary,
                               const RunControl& = {});
InitialState run_preconditioned(const Scene&, InitialState, OutputSink&, RunSummary& summary,
                                const RunControl& = {});

}  // namespace myowave::solver
