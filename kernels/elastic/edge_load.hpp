// The load on the edge of the sheet (Nash & Panfilov 2004, Eq 19): tension p along the outward
// normal, per deformed length (follower) or per undeformed length and direction (dead).
//
// The boundary is closed, so both equal a bulk term, which the elements use:
//
//   follower: potential -p J      (the area inside the boundary is the integral of J)
//   dead:     potential -p tr F   (integral of N . x over the boundary = integral of div x)
//
// At most one of them is not zero. Both are zero if the boundary is fixed.
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/elastic/stress.hpp"

namespace myowave::elastic {

struct EdgeLoad {
  double follower = 0;  // kN/m, positive stretches; the paper's is 10
  double dead = 0;      // kN/m
};

// Adds -p J = -p sqrt A.
KOKKOS_FORCEINLINE_FUNCTION void add_follower_load(double p, double A, EnergyDerivatives& w) {
  const double J = Kokkos::sqrt(A);
  const double inv_A = 1 / A, inv_J = J * inv_A;
  w.w -= p * J;
  w.w_A -= 0.5 * p * inv_J;
  w.w_AA += 0.25 * p * inv_A * inv_J;
}

// The same load as the force on each end of the edge a -> b, with the sheet on its left.
struct EdgeForce {
  double f1, f2;
};

KOKKOS_INLINE_FUNCTION constexpr EdgeForce edge_force(double p, double a1, double a2, double b1, double b2) {
  return {0.5 * p * (b2 - a2), -0.5 * p * (b1 - a1)};
}

}  // namespace myowave::elastic
