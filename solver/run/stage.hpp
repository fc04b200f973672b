// One stage of a run: the scene itself, or one of its preconditions.
#pragma once

#include <string>

#include "solver/base/archive.hpp"
#include "solver/base/run_output.hpp"
#include "solver/run/run_control.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// References to what the caller holds while the stage runs.
struct StageContext {
  const Scene& scene;
  const RunControl& control;
  OutputSink& sink;
  RunSummary& summary;  // of the stage
  RunSummary& whole;    // of the whole run: gets the warnings and substeps of the stage
  RunStage stage;
};

// Runs the stage from the initial state, or, if `saved` is not null, from the state that it reads.
// Returns the state at its end. Errors: those of run().
InitialState run_stage(const StageContext&, InitialState, StateReader* saved);

// Adds a warning to the summary and shows it.
void warn(OutputSink&, RunSummary&, const std::string& text);

}  // namespace myowave::solver
