// Explicit steps at some dt on a sheet that is held deformed: a broken front, with the kernels of a run and
// without mechanics.
#pragma once

#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

struct StepTrial {
  GridSettings grid;
  MetricForm form = MetricForm::none;  // none: the rigid sheet
  Precision precision = Precision::float64;
  Scheme scheme = Scheme::euler;
  int cells_per_element = 10;
  std::vector<double> nodes;  // (element rows + 1, element columns + 1, 2), length units; rigid: unused
  double front_width = 5;     // of the broken front, node spacings
  double duration = 60;       // t.u.
};

enum class StepOutcome { right, wrong, blown_up };

struct StepReport {
  bool blown_up = false;  // V not finite or beyond +-10
  double noise = 0;       // largest at any sample, see kernels/observe/state_check.hpp
  double min_V = 0, max_V = 0;
  bool told = false;  // the check of a run (solver/excitation/state_check.hpp) finds an invalid state

  // Wrong: finite, but with more grid-scale noise than the steepest front makes, or a V above 1.
  StepOutcome outcome() const;
};

struct StabilityBounds {
  double max_trace_inverse_C = 2;
  double excited = 0;  // t.u.: largest_stable_dt, which a run keeps
  double at_rest = 0;  // t.u.: the same where V = 0, whose reaction -k a V is the slower one
};

StabilityBounds stability_bounds(const StepTrial&);

// Samples the state once per t.u., for noise and range of V from 5 t.u. on: the front starts as a jump,
// which is grid-scale noise until it has spread. To let a growing mode show within the run, V starts with
// 1e-6 of alternating sign at each node.
StepReport try_steps(const StepTrial&, double dt);

}  // namespace myowave::solver
