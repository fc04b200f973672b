// How long `myowave run` takes for a scene, estimated from the start of that run.
#pragma once

#include "solver/scene/scene.hpp"

namespace myowave::apps {

// Wall-clock seconds on this machine under its present load.
struct Estimate {
  double settling_s = 0;       // the settled spiral, if it is not in the cache
  double preconditions_s = 0;  // none: 0
  double scene_s = 0;          // with all its outputs

  double total_s() const { return settling_s + preconditions_s + scene_s; }
};

// Takes about 2 s, or less for a shorter run. Runs the start of each precondition, or of the scene if it has
// none, without outputs. From that state it runs the scene for a while into a temporary folder. Both times
// are extrapolated to the end. A broken front replaces a settled spiral that is not in the cache. Errors:
// NumericalFailure if these first steps fail; InputError if there is no temporary folder.
Estimate estimate(const solver::Scene&);

}  // namespace myowave::apps
