// Ellipticity of the membrane: Q_ij(N) = A_iMjN N_M N_N, the acoustic tensor of the undeformed
// direction N. Its eigenvalues are the stiffness against a fine wave along N. If the smallest is not positive
// the sheet may fold on any scale, and the solution depends on the mesh.
//
// An edge load adds nothing to Q: the second derivative of J is antisymmetric in M and N.
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/elastic/element.hpp"
#include "kernels/elastic/element_grid.hpp"
#include "kernels/elastic/stress.hpp"

namespace myowave::elastic {

// The smaller eigenvalue of Q along (cos angle, sin angle), kPa.
KOKKOS_INLINE_FUNCTION double acoustic_modulus(const SpatialTangent& A, double angle) {
  const double c = Kokkos::cos(angle), s = Kokkos::sin(angle);
  const double Q11 = A.a1111 * c * c + 2 * A.a1112 * c * s + A.a1212 * s * s,
               Q22 = A.a2121 * c * c + 2 * A.a2122 * c * s + A.a2222 * s * s,
               Q12 = A.a1121 * c * c + (A.a1122 + A.a1221) * c * s + A.a1222 * s * s;
  return 0.5 * (Q11 + Q22) - Kokkos::sqrt(0.25 * (Q11 - Q22) * (Q11 - Q22) + Q12 * Q12);
}

// The smallest over all directions: of 16, then by search between the neighbours of the lowest one.
KOKKOS_INLINE_FUNCTION double least_acoustic_modulus(const SpatialTangent& A) {
  constexpr int directions = 16;
  constexpr int thirds = 20;  // shrinks the interval to 3e-4: the minimum is accurate to 1e-7
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

// Whether Q is positive definite in every direction, exactly. Along the principal stretches a and b, at the
// angle x to the first, det Q = P cos^4 x + R cos^2 x sin^2 x + S sin^4 x.
KOKKOS_INLINE_FUNCTION bool is_elliptic(const EnergyDerivatives& w, const Mat2& F) {
  const double t = F.m11 * F.m11 + F.m12 * F.m12 + F.m21 * F.m21 + F.m22 * F.m22, J = determinant(F);
  const double sum = Kokkos::sqrt(t + 2 * J), difference = Kokkos::sqrt(Kokkos::max(t - 2 * J, 0.0));
  const SpatialTangent A = spatial_tangent(w, {0.5 * (sum + difference), 0, 0, 0.5 * (sum - difference)});
  const double mixed = A.a1122 + A.a1221;
  const double P = A.a1111 * A.a2121, S = A.a2222 * A.a1212,
               R = A.a1111 * A.a2222 + A.a1212 * A.a2121 - mixed * mixed;
  return A.a1111 > 0 && A.a2222 > 0 && A.a1212 > 0 && A.a2121 > 0 && R + 2 * Kokkos::sqrt(P * S) > 0;
}

// Gauss points at which the membrane is not elliptic. Nodes (nodes, 2), length units; Ta (elements, 4), kPa.
// Fences to return the count.
template <class Space>
int count_not_elliptic(const Space& space, const Membrane& membrane, const ElementGrid& grid,
                       const Nodes<typename Space::memory_space>& nodes,
                       const GaussTension<typename Space::memory_space>& Ta) {
  int count = 0;
  Kokkos::parallel_reduce(
      "myowave::elastic::count_not_elliptic", Kokkos::RangePolicy<Space>(space, 0, grid.elements()),
      KOKKOS_LAMBDA(int e, int& found) {
        const auto element = element_nodes(grid, nodes, e);
        for (int q = 0; q < gauss_points; ++q) {
          const Mat2 F = gauss_deformation_gradient(element, q, grid.h);
          found += is_elliptic(membrane_energy(membrane, Ta(e, q), F), F) ? 0 : 1;
        }
      },
      count);
  return count;
}

}  // namespace myowave::elastic
