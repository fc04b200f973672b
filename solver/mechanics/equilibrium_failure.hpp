// Attempts of a solve of the equilibrium, and the message if it failed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "solver/mechanics/newton.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// All attempts of one solve together.
struct Effort {
  std::int64_t iterations = 0, factorizations = 0, shifts = 0, halvings = 0, ramp_steps = 0;
  double largest_shift = 0;  // kPa
  double ramp_reached = -1;  // fraction of the tension; < 0: no ramp was tried
  PhaseTimes time;
  NewtonReport last;

  void add(const NewtonReport& report) {
    iterations += report.iterations;
    factorizations += report.factorizations;
    shifts += report.shifts;
    halvings += report.halvings;
    largest_shift = std::max(largest_shift, report.largest_shift);
    time += report.time;
    last = report;
  }
};

// Where the last attempt stopped.
struct FailedState {
  double time = 0;                // t.u.
  double min_Ta = 0, max_Ta = 0;  // kPa
  double area = 1;                // over the undeformed one
  double min_J = 1;               // smallest at a corner, in the element
  int row = 0, column = 0;
};

// Time, tension, load, what was tried, what was reached, and what to do.
std::string failure_message(const MechanicsSettings&, const FailedState&, const Effort&);

// The load and the material leave no rest state (solver/mechanics/rest_state.hpp): no solve was tried.
std::string no_rest_state_message(const std::string& reason, double time);

// The tension of an element is not a number: no solve was tried.
std::string broken_tension_message(double time, int row, int column);

}  // namespace myowave::solver
