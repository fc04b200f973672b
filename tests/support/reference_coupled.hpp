// The coupled step in its order, on top of the plain references of its two halves.
#pragma once

#include "solver/scene/scene.hpp"
#include "tests/support/reference_excitation.hpp"

namespace myowave::reference {

struct CoupledState {
  ExcitationState fields;
  Values nodes;    // of the last solve that conduction feels; empty in a rigid run
  int solves = 0;  // made after that of the rest state
};

// I_s at every node at time t.
Values stimulus(const solver::Scene&, double t);

// The diffusion term that the scene asks for.
Values diffusion(const solver::Scene&, const Values& nodes, const Values& V);

// The state at t = steps dt as it is sampled there: a solve that is due has been made. Ignores
// scene.initial, time.t_end, precision and output. Throws std::runtime_error without equilibrium.
CoupledState run(const solver::Scene&, const ExcitationState& initial, int steps);

}  // namespace myowave::reference
