// Ellipticity of the membrane: Q_ij(N) = A_iMjN N_M N_N, the acoustic tensor of the undeformed
// direction N. Its eigenvalues are the stiffness against a fine wave along N; where the smallest is not
// positive the sheet may fold on any scale, and a mesh decides what is found.
//
// An edge load has no part in Q: the second derivative of J is antisymmetric in M and N.
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/elastic/stress.hpp"

namespace myowave::elastic {

// The smaller eigenvalue of Q along (cos angle, sin angle), in the unit of A.
KOKKOS_INLINE_FUNCTION double acoustic_modulus(const SpatialTangent& A, double angle) {
  const double c = Kokkos::cos(angle), s = Kokkos::sin(angle);
  const double Q11 = A.a1111 * c * c + 2 * A.a1112 * c * s + A.a1212 * s * s,
               Q22 = A.a2121 * c * c + 2 * A.a2122 * c * s + A.a2222 * s * s,
               Q12 = A.a1121 * c * c + (A.a1122 + A.a1221) * c * s + A.a1222 * s * s;
  return 0.5 * (Q11 + Q22) - Kokkos::sqrt(0.25 * (Q11 - Q22) * (Q11 - Q22) + Q12 * Q12);
}

// The smallest over all directions: of 16, then between the neighbours of the lowest one.
KOKKOS_INLINE_FUNCTION double least_acoustic_modulus(const SpatialTangent& A) {
  constexpr int directions = 16;
  constexpr int thirds = 20;  // leave 3e-4 of the interval: 1e-7 of the minimum
  constexpr double apart = 3.14159265358979323846 / directions;
  int lowest = 0;
  double least = acoustic_modulus(A, 0);
  for (int n = 1; n < directions; ++n) {
    const double modulus = acoustic_modulus(A, n * apart);
    if (modulus < least) {
      least = modulus;
      lowest = n;
    }
  }
  double low = (lowest - 1) * apart, high = (lowest + 1) * apart;
  for (int n = 0; n < thirds; ++n) {
    const double third = (high - low) / 3;
    if (acoustic_modulus(A, low + third) < acoustic_modulus(A, high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  return Kokkos::min(least, acoustic_modulus(A, 0.5 * (low + high)));
}

}  // namespace myowave::elastic
