// How a run is executed, stopped, saved and resumed.
#pragma once

#include <atomic>

#include "solver/base/execution.hpp"
#include "solver/run/checkpoint.hpp"

namespace myowave::solver {

// How to execute a run. Its results do not depend on it.
struct RunControl {
  Execution execution{};
  const std::atomic<bool>* stop = nullptr;  // true: the run throws Interrupted at its next sample
  // Saves checkpoints, at output.checkpoint_every and when the run is asked to stop.
  CheckpointKeeper* checkpoints = nullptr;
  // A checkpoint of the same scene to resume from; the initial state is then ignored.
  const FoundCheckpoint* resume = nullptr;
};

}  // namespace myowave::solver
