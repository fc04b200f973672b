// Bounds of stable steps and of valid states, and what can be checked before a run.
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
//   split: 2 C_m / (4 D s / dx^2 + k (1 - a + a^2) / 3): diffusion damps the fastest growth by the reaction;
//          and 2 C_m / (k max(a, 1 - a)), the limit of the midpoint rule.
double largest_stable_dt(const Scene&, double stiffness);

// Number of substeps that bring dt under that bound; 1 if dt is within it.
int needed_substeps(double dt, double stable_dt);
// More are not tried: smaller steps cannot repair a sheet or a state that needs more.
inline constexpr int most_substeps = 64;

// Range of V and r in a valid run. The maximum principle of Eq 22a: without diffusion and current nothing
// drives V out of [0, 1], and diffusion makes no new extremes (of a rigid step; see the margin); r obeys Eq
// 22b on that range of V.
struct CleanRange {
  double min_V, max_V, min_r;

  // How far a discrete step may exceed the range, relative to the larger of 1 and the bound: it overshoots by
  // at most 0.021 if dt is at its bound (k = 40), and by 0.1 and more if dt is above it.
  static constexpr double margin = 0.05;

  // On a deformed metric a step can make new extremes: oblique weights have both signs. Ahead of a front V
  // falls to -0.12 on a sheet sheared by 1.5, at any dt (`myowave stability --map dt_shear`).
  static constexpr double undershoot_of_sheared_front = 0.1;

  // Stays above V = -mu2, the pole of Eq 22b, if the initial state is above it.
  CleanRange with_margin(const Scene&) const;
};
CleanRange clean_range(const Scene&, const InitialState&);

// V that alternates from node to node and from step to step by more than this, without decaying, is noise.
// Valid runs reach 0.0008, and 0.024 if D is so small that a front is sharper than the grid; above the
// bound it is 0.04 to 0.5 (solver/studies/unstable_steps.md).
inline constexpr double largest_clean_noise = 0.03;

// Refuses steps that are certainly unstable: dt above the bound of the undeformed sheet, eps dt > 1, a
// stimulus that in one step lifts V so far that the next steps blow up. `where` ends the sentence of the
// message. Errors: InputError with the bound.
void require_stable(const Scene&, const char* where);

// Refuses an initial state from which r certainly diverges, or from which the first step takes r past zero.
// Errors: InputError with the node.
void require_clean_start(const Scene&, const InitialState&);

// No equibiaxial state of the membrane loses ellipticity below this tension, kPa (c1 = 2, c2 = 6 kPa).
inline constexpr double elliptic_tension = 60.2;

// Warnings about settings that are allowed but doubtful.
std::vector<std::string> warnings_of(const Scene&);

}  // namespace myowave::solver
