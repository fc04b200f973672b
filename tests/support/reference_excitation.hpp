// A plain serial reference of the excitation (Eqs 22a-c, 23) on the sheet and of the three forms of
// its diffusion term, and of the phase singularities. No Kokkos, nothing shared with kernels/ or
// solver/. All arrays are row-major fields of a Grid.
#pragma once

#include <vector>

#include "solver/scene/scene.hpp"
#include "tests/support/reference_mechanics.hpp"

namespace myowave::reference {

// Five-point stencil, mirrored about the boundary nodes.
Values diffusion_identity(const Grid&, const Values& V);

// Nine-point stencil [1 4 1; 4 -20 4; 1 4 1] / (6 dx^2), mirrored about the boundary nodes.
Values diffusion_nine_point(const Grid&, const Values& V);

// The gradient of every cell's energy on the deformed metric, over the nodes' weights. `twist`: what part of
// (G11 + G22) (V00 + V11 - V10 - V01)^2 / 2 is taken from the energy; 1/12 for the nine-point stencil.
Values diffusion_conservative(const Grid&, const Mesh&, const Values& x, const Values& V, double twist = 0);

// M_i: a quarter of sqrt C of each adjacent cell.
Values node_weights(const Grid&, const Mesh&, const Values& x);

// Eq 24 as printed: g^ML (V_,ML - Gamma^N_ML V_,N).
Values diffusion_expanded(const Grid&, const Mesh&, const Values& x, const Values& V);

// dV/dt, the whole right-hand side of Eq 22a over C_m; I_s and the diffusion term at every node.
Values voltage_rate(const solver::ExcitationSettings&, const Values& V, const Values& r,
                    const Values& diffusion, const Values& I_s);

struct ExcitationState {
  Values V, r, Ta;
};

// One explicit Euler step; V, r and Ta all advance from the old state.
ExcitationState euler_step(const solver::ExcitationSettings&, const solver::TensionSettings&, double dt,
                           const ExcitationState&, const Values& diffusion, const Values& I_s);

// Diffusion for dt, then reaction for dt: V by the explicit midpoint rule, r and Ta by two terms of their
// Taylor series at the V of the middle.
ExcitationState split_step(const solver::ExcitationSettings&, const solver::TensionSettings&, double dt,
                           const ExcitationState&, const Values& diffusion);

// Material coordinates in length units; charge +1 where (V - 0.5, dV/dt) winds counter-clockwise.
struct PhaseSingularity {
  double x, y;
  int charge;
};

// One for each grid square around which the pair winds once, in row-major order of the squares. A
// square with the origin on an edge of its image has no winding number and counts as none.
std::vector<PhaseSingularity> phase_singularities(const Grid&, const Values& V, const Values& dV_dt);

}  // namespace myowave::reference
