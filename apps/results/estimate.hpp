// How long `myowave run` takes for a scene, estimated from the start of that run.
#pragma once

#include "solver/scene/scene.hpp"

namespace myowave::apps {

// Wall-clock seconds on this machine as it is now.
struct Estimate {
  double settling_s = 0;       // the settled spiral, where the cache lacks it
  double preconditions_s = 0;  // none: 0
  double scene_s = 0;          // with all its outputs

  double total_s() const { return settling_s + preconditions_s + scene_s; }
};

// Takes about 2 s, or less where the run does. The begin of what comes first, or else of the scene, is run
// without outputs; from the state that it leaves the scene is then run into a temporary folder and watched.
// Both are extrapolated to their ends. Where the cache lacks the settled spiral, a broken front stands in.
// Errors: NumericalFailure where these first steps fail; InputError where there is no temporary folder.
Estimate estimate(const solver::Scene&);

}  // namespace myowave::apps
