// Aliev-Panfilov excitation at a point (Nash & Panfilov 2004, Eqs 22a, b without diffusion):
//   f(V, r) = -k V (V - a)(V - 1) - r V
//   r_t     = (eps + mu1 r / (mu2 + V)) (-r - k V (V - b - 1))
#pragma once

#include <Kokkos_Macros.hpp>

#include "kernels/cell/parameters.hpp"

namespace myowave::cell {

template <class Real>
struct AlievPanfilov : AlievPanfilovParameters<Real> {
  using Parameters = AlievPanfilovParameters<Real>;
  using Parameters::a;
  using Parameters::b;
  using Parameters::eps;
  using Parameters::k;
  using Parameters::mu1;
  using Parameters::mu2;

  // f(V, r): the reaction part of dV/dt, 1/t.u.
  KOKKOS_FORCEINLINE_FUNCTION Real excitation(Real V, Real r) const {
    return -k * V * (V - a) * (V - Real(1)) - r * V;
  }

  // df/dV and df/dr, 1/t.u.
  KOKKOS_FORCEINLINE_FUNCTION Real excitation_by_V(Real V, Real r) const {
    return -k * ((Real(3) * V - Real(2) * (a + Real(1))) * V + a) - r;
  }
  KOKKOS_FORCEINLINE_FUNCTION Real excitation_by_r(Real V) const { return -V; }

  // dr/dt, 1/t.u.
  KOKKOS_FORCEINLINE_FUNCTION Real recovery(Real V, Real r) const {
    return (eps + mu1 * r / (mu2 + V)) * (-r - k * V * (V - b - Real(1)));
  }

  // r after dt (t.u.) at constant V, to second order: r + dt r_t + dt^2 / 2 r_tt.
  KOKKOS_FORCEINLINE_FUNCTION Real recovered(Real V, Real r, Real dt) const {
    const Real per_r = mu1 / (mu2 + V), rate = eps + per_r * r;
    const Real distance = -r - k * V * (V - b - Real(1));
    return r + dt * rate * distance * (Real(1) + Real(0.5) * dt * (per_r * distance - rate));
  }
};

}  // namespace myowave::cell
