// Maps of the parameters at the ends of their ranges: what a run makes of them.
#pragma once

#include <functional>
#include <string>

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"
#include "solver/studies/map_table.hpp"

namespace myowave::solver {

// One run, from the scene's initial state or what `prepare` makes of it. It is compared with a run in
// float64 at `reference_dt`, t.u., whose solves of the mechanics come at the same times.
struct ParameterCase {
  std::string what;  // "excitation.mu1"
  std::string value;
  Scene scene;
  std::function<void(InitialState&)> prepare{};
  double reference_dt = 0;  // 0: an eighth of the scene's
};

enum class ParameterOutcome {
  right,    // within `largest_error` of the reference
  refused,  // InputError
  stopped,  // NumericalFailure
  warned,   // finished, is not right, and has said so
  wrong,    // finished, and is not right
};

struct ParameterResult {
  ParameterOutcome outcome = ParameterOutcome::wrong;
  double error = 0;      // of V and r at the end, 2-norm over the reference's
  double largest_V = 0;  // at the end
  std::string reason;    // of a refusal, a stop or a warning
};

// A wave front of the paper's step and spacing is 0.03 off after 10 t.u.
inline constexpr double largest_error = 0.1;

ParameterResult run_case(const ParameterCase&);

MapTable make_parameters(const MapProgress&);

// Sum of M_i V_i while sheet and metric are held and nothing reacts, M_i the deformed areas of the nodes.
struct ConservedSum {
  double before = 0, after = 0;
  double drift() const { return after / before - 1; }
};

// `steps` steps of pure diffusion on n x n nodes deformed by a front of tension.
ConservedSum diffuse_on_held_sheet(Precision, int n, std::int64_t steps);

// The last state of a sheet of n x n nodes that is left alone after a stimulus, for `steps` steps.
struct RestingSheet {
  InitialState state;
  double first_s = 0, last_s = 0;  // of the first and the last tenth of the steps
};
RestingSheet leave_alone(Precision, int n, std::int64_t steps);

MapTable make_long_runs(const MapProgress&);

}  // namespace myowave::solver
