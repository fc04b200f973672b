// Which steps are stable, what a clean run cannot show, and what can be told of both beforehand.
#pragma once

#include <string>
#include <vector>

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// The stiffness s of a cell (transfer::cell_stiffness) for F = I: 2, and 4 / 3 of the nine-point stencil.
double undeformed_stiffness(const Scene&);

// dt must not exceed this, at the largest stiffness s of the FD cells. Each cell's energy is then bounded by
// its mass, for any F.
//   euler: 2 C_m / (4 D s / dx^2 + k max(a, 1 - a)): no grid mode grows at V = 0 and V = 1;
//   split: 2 C_m / (4 D s / dx^2 + k (1 - a + a^2) / 3): what the reaction lets grow at most, the diffusion
//          damps; and 2 C_m / (k max(a, 1 - a)), where the midpoint rule ends.
double largest_stable_dt(const Scene&, double stiffness);

// Into how many steps one of dt must be divided under that bound; 1 where it holds.
int needed_substeps(double dt, double stable_dt);
// More are not tried: a sheet or a state that needs them is beyond repair by smaller steps.
inline constexpr int most_substeps = 64;

// What V and r stay in. The maximum principle of Eq 22a: without diffusion and current nothing drives V
// out of [0, 1], and diffusion makes no new extremes (of a rigid step; see the margin); r obeys Eq 22b on
// that range of V.
struct CleanRange {
  double min_V, max_V, min_r;

  // What the discrete step may go beyond by, of the larger of 1 and the bound: it overshoots by at most
  // 0.021 where dt is at its bound (k = 40), and by 0.1 and more where it is past it.
  static constexpr double margin = 0.05;

  // On a deformed metric a step can make new extremes: oblique weights are of both signs. Before a front it
  // goes down to V = -0.12 on a sheet sheared by 1.5, at any dt (`myowave stability --map dt_shear`).
  static constexpr double undershoot_of_sheared_front = 0.1;

  // Not down to V = -mu2, the pole of Eq 22b, where the start is above it.
  CleanRange with_margin(const Scene&) const;
};
CleanRange clean_range(const Scene&, const InitialState&);

// V that alternates from node to node and from step to step by more than this, without decaying, is noise.
// Clean runs reach 0.0008, and 0.024 where D is so small that a front is sharper than the grid; past the
// bound it is 0.04 to 0.5 (solver/studies/unstable_steps.md).
inline constexpr double largest_clean_noise = 0.03;

// Refuses steps that are certainly unstable: dt past the bound of the undeformed sheet, eps dt > 1, a
// stimulus that in one step lifts V to where the next steps blow up. `where` ends the sentence.
// Errors: InputError with the bound.
void require_stable(const Scene&, const char* where);

// Refuses a start from which r certainly runs away, or whose first step throws r past zero.
// Errors: InputError with the node.
void require_clean_start(const Scene&, const InitialState&);

// No equibiaxial state of the membrane loses ellipticity below this tension, kPa (c1 = 2, c2 = 6 kPa).
inline constexpr double elliptic_tension = 60.2;

// What a scene is allowed to ask for but should know.
std::vector<std::string> warnings_of(const Scene&);

}  // namespace myowave::solver
