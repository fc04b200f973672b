// One explicit step of the monodomain equations with active tension (Eqs 22a-c) along a row, by one of two
// schemes. Both read the neighbours once.
#pragma once

#include "kernels/base/row_loop.hpp"
#include "kernels/tissue/diffusion.hpp"

namespace myowave::tissue {

// A node's state.
template <class Real>
struct NodeState {
  Real V, r, Ta;  // -, -, kPa
};

// The paper's:
//   V += dt (D diffusion(V) + f(V, r)) / C_m,   r += dt r_t,   Ta += dt Ta_t,
// all three from the old state.
struct ForwardEuler {
  // V at the time of a state.
  template <class Model, class Real>
  KOKKOS_FORCEINLINE_FUNCTION static Real seen(const Model&, Real /*dt*/, Real V, Real /*r*/) {
    return V;
  }

  template <class Model, class Real>
  KOKKOS_FORCEINLINE_FUNCTION static NodeState<Real> advance(const Model& model, Real dt,
                                                             const NodeState<Real>& old, Real diffused) {
    NodeState<Real> next = old;
    next.V += dt * model.inverse_C_m * (model.D * diffused + model.cell.excitation(old.V, old.r));
    next.r += dt * model.cell.recovery(old.V, old.r);
    if constexpr (Model::has_tension) next.Ta += dt * model.tension.rate(old.V, old.Ta);
    return next;
  }
};

// Diffusion for dt, then reaction for dt: Strang's splitting, seen half a reaction away from its symmetric
// state, which changes no speed, period or path. The reaction is of second order: V by the implicit midpoint
// rule with one step of Newton's method (Rosenbrock 1963), which comes back from any V that a stimulus lifts
// it to, where the explicit rule stays above V = 2 at dt = 0.1; r and Ta at the V of the middle by two terms
// of their series, as Rush & Larsen (1978) integrate gates.
//
// The diffusion's Euler step alone would be of first order. Its error, dt D / 2 laplacian^2 V, is the one of
// the nine-point stencil with the other sign where
//   dt = dx^2 / (6 D):
// there both are gone, and the scheme is of fourth order in space and of second in time.
struct SplitStep {
  // V at the time of a state: half a reaction back.
  template <class Model, class Real>
  KOKKOS_FORCEINLINE_FUNCTION static Real seen(const Model& model, Real dt, Real V, Real r) {
    return V - Real(0.5) * dt * model.inverse_C_m * model.cell.excitation(V, r);
  }

  template <class Model, class Real>
  KOKKOS_FORCEINLINE_FUNCTION static NodeState<Real> advance(const Model& model, Real dt,
                                                             const NodeState<Real>& old, Real diffused) {
    const Real V = old.V + dt * model.inverse_C_m * model.D * diffused;
    const Real half = Real(0.5) * dt * model.inverse_C_m;
    const Real to_middle =
        half * model.cell.excitation(V, old.r) / (Real(1) - half * model.cell.excitation_by_V(V, old.r));
    const Real V_middle = V + to_middle;
    NodeState<Real> next = old;
    next.r = model.cell.recovered(V_middle, old.r, dt);
    next.V = V_middle + to_middle + half * (next.r - old.r) * model.cell.excitation_by_r(V_middle);
    if constexpr (Model::has_tension) next.Ta = model.tension.relaxed(V_middle, old.Ta, dt);
    return next;
  }
};

// Any cell and tension model with the functions of AlievPanfilov and ActiveTension will do: the
// model is a template parameter, so that tissue/ does not depend on one.
template <class Cell, class Tension, class Scheme = ForwardEuler>
struct MonodomainModel {
  using Real = decltype(Cell{}.k);
  using TimeScheme = Scheme;
  static constexpr bool has_tension = Tension::integrated;
  Cell cell;
  Tension tension;
  Real D = 1;            // conductivity, length^2/t.u.
  Real inverse_C_m = 1;  // 1 / membrane capacitance
};

// The old state of a row and where the new one goes, counted from the same column as the stencil. r_next
// and Ta_next may be r and Ta. Without tension Ta and Ta_next are not read.
template <class Model>
struct NodeUpdate {
  using Real = typename Model::Real;
  Model model;
  Real dt;
  const Real* V;
  const Real* r;
  const Real* Ta;
  Real* V_next;
  Real* r_next;
  Real* Ta_next;

  KOKKOS_FORCEINLINE_FUNCTION void operator()(int j, Real diffused) const {
    NodeState<Real> old{V[j], r[j], 0};
    if constexpr (Model::has_tension) old.Ta = Ta[j];
    const NodeState<Real> next = Model::TimeScheme::advance(model, dt, old, diffused);
    V_next[j] = next.V;
    r_next[j] = next.r;
    if constexpr (Model::has_tension) Ta_next[j] = next.Ta;
  }

  KOKKOS_FORCEINLINE_FUNCTION void prefetch(int j) const {
    prefetch_to_read(r + j);
    prefetch_to_write(V_next + j);
    prefetch_to_write(r_next + j);
    if constexpr (Model::has_tension) {
      prefetch_to_read(Ta + j);
      prefetch_to_write(Ta_next + j);
    }
  }
};

// Updates columns begin <= j < end of a row in memory; those at the ends of the sheet see mirrored
// neighbours.
template <class Columns, class Row, class Update>
KOKKOS_FORCEINLINE_FUNCTION void update_row(const Columns& lanes, int begin, int end, int columns,
                                            const Row& row, const Update& update) {
  // Between 1 and 4 kB ahead it is all the same on an EPYC.
  constexpr int ahead = 2048 / sizeof(typename Update::Real);
  const int right = columns - 1;
  lanes.each(
      Kokkos::max(begin, 1), Kokkos::min(end, right), [=](int j) { update(j, row(j - 1, j, j + 1)); },
      [=](int j) {
        row.prefetch(j + ahead);
        update.prefetch(j + ahead);
      });
  if (begin == 0 || end == columns)
    lanes.once([=]() {
      if (begin == 0) update(0, row(1, 0, 1));
      if (end == columns) update(right, row(right - 1, right, right - 1));
    });
}

}  // namespace myowave::tissue
