// Active tension at a point (Nash & Panfilov 2004, Eqs 22c, 23):
//   Ta_t = eps_T(V) (k_Ta V - Ta),   eps_T = eps_below for V < threshold, eps_above from there on.
// The paper's Eq 23 (0.1 : 1 the other way round, law "printed") lets Ta follow V at once; with
// eps_below = 1 and eps_above = 0.1 (law "delayed") tension lags V as in the paper's Fig 2a.
#pragma once

#include <Kokkos_Macros.hpp>

#include "kernels/cell/parameters.hpp"

namespace myowave::cell {

template <class Real>
struct ActiveTension : ActiveTensionParameters<Real> {
  using Parameters = ActiveTensionParameters<Real>;
  using Parameters::eps_above;
  using Parameters::eps_below;
  using Parameters::k_Ta;
  using Parameters::threshold;
  static constexpr bool integrated = true;

  // dTa/dt, kPa/t.u.
  KOKKOS_FORCEINLINE_FUNCTION Real rate(Real V, Real Ta) const { return relaxation(V) * (k_Ta * V - Ta); }

  // Ta after dt (t.u.) at constant V, kPa: the exponential to second order, which stays between Ta and k_Ta V
  // for eps_T dt <= 2.
  KOKKOS_FORCEINLINE_FUNCTION Real relaxed(Real V, Real Ta, Real dt) const {
    const Real z = dt * relaxation(V);
    return Ta + z * (Real(1) - Real(0.5) * z) * (k_Ta * V - Ta);
  }

 private:
  // eps_T(V), 1/t.u.
  KOKKOS_FORCEINLINE_FUNCTION Real relaxation(Real V) const { return V < threshold ? eps_below : eps_above; }
};

// For scenes that do not need Ta.
struct NoTension {
  static constexpr bool integrated = false;
};

}  // namespace myowave::cell
