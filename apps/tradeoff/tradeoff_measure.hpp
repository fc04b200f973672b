// What `myowave tradeoff` measures of one setting: a plane wave on a strip, and the scene itself.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

struct Measures {
  struct Curve {
    std::vector<double> t, value;
  };

  std::map<std::string, double, std::less<>> numbers;  // by the name of the observable
  Curve area;                                          // at the solves of the mechanics
  std::vector<double> V_half, V_end;                   // on the scene's own grid; empty: not seen
  std::vector<solver::Tip> tips;                       // at the end
};

// When a scene is sampled, t.u.
struct Sampling {
  double every = 1;  // areas and tips
  double half = 0;   // V, besides at the end
  double end = 0;
};

Sampling sampling_of(const solver::Scene&);

struct MeasuredRun {
  Measures measures;
  double wall_s = 0;
  double cell_steps_per_s = 0;
};

// A plane wave from one end of a rigid strip of 120 length units with the scene's cells, D, dt, dx, scheme
// and precision: `cv` between the thirds (length units / t.u.) and `apd` in the middle (V > 0.1, t.u.).
// Without a wave there is neither.
// Errors: as solver::run.
Measures measure_plane_wave(const solver::Scene&);

// The state that the scene itself starts from, after its preconditions. Errors: as solver::run.
solver::InitialState start_of(const solver::Scene&);

// The scene, on the grid of its own accuracy, from a state on the grid `own`. Without files.
// Errors: as solver::run.
MeasuredRun measure_scene(solver::Scene, const solver::InitialState& start, const solver::GridSettings& own,
                          const Sampling&, const std::string& name);

}  // namespace myowave::apps
