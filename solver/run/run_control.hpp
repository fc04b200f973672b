// How a run is executed, stopped, saved and resumed.
#pragma once

#include <atomic>

#include "solver/base/execution.hpp"
#include "solver/run/checkpoint.hpp"

namespace myowave::solver {

// How a run is run. What it computes does not depend on it.
struct RunControl {
  Execution execution{};
  const std::atomic<bool>* stop = nullptr;  // true: the run ends at its next look, by Interrupted
  // Where checkpoints go, at output.checkpoint_every and when the run is asked to stop.
  CheckpointKeeper* checkpoints = nullptr;
  // What the run goes on from, of the same scene; the initial state is not looked at then.
  const FoundCheckpoint* resume = nullptr;
};

}  // namespace myowave::solver
