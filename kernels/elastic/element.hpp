// Energy, residual and tangent of one element (Nash & Panfilov 2004, Eqs 15-19), 2 x 2 Gauss points:
//
//   Pi      = sum_g w_g [w + Ta ln J - p J]                                     (dead load: - p tr F)
//   R_(n,i) = sum_g w_g P_iM Psi_n,M                  P = dw/dF                 (dead load: - p I)
//   K_(n,i)(m,j) = sum_g w_g Psi_n,M A_iMjN Psi_m,N   A = dP/dF
//
// Pi is a potential for both loads: R is its gradient, K its symmetric second derivative. All functions are
// inlined and have no loops, so that a loop over elements vectorises.
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/base/tensor2.hpp"
#include "kernels/elastic/active_stress.hpp"
#include "kernels/elastic/edge_load.hpp"
#include "kernels/elastic/kinematics.hpp"
#include "kernels/elastic/mooney_rivlin.hpp"
#include "kernels/elastic/stress.hpp"

namespace myowave::elastic {

// The lower triangle of K by rows: entry (a, b), b <= a, at a (a + 1)/2 + b.
inline constexpr int tangent_entries = element_dofs * (element_dofs + 1) / 2;
KOKKOS_INLINE_FUNCTION constexpr int tangent_entry(int a, int b) { return a * (a + 1) / 2 + b; }

struct Membrane {
  MooneyRivlin passive;
  EdgeLoad load;
};

KOKKOS_FORCEINLINE_FUNCTION EnergyDerivatives membrane_energy(const Membrane& membrane, double Ta,
                                                              const Mat2& F) {
  const double J = determinant(F), A = J * J;
  EnergyDerivatives w =
      passive_energy(membrane.passive, F.m11 * F.m11 + F.m12 * F.m12 + F.m21 * F.m21 + F.m22 * F.m22, A);
  add_active_tension(Ta, A, w);
  add_follower_load(membrane.load.follower, A, w);
  return w;
}

// w at Gauss point q including the load, kPa.
KOKKOS_FORCEINLINE_FUNCTION double gauss_energy(const Membrane& membrane, const ElementNodes& element,
                                                double Ta, int q, double h) {
  const Mat2 F = gauss_deformation_gradient(element, q, h);
  return membrane_energy(membrane, Ta, F).w - membrane.load.dead * (F.m11 + F.m22);
}

// Pi of the element, kPa x area. Ta at its four Gauss points, kPa. J must be positive.
KOKKOS_FORCEINLINE_FUNCTION double element_energy(const Membrane& membrane, const ElementNodes& element,
                                                  const double (&Ta)[gauss_points], double h) {
  return 0.25 * h * h *
         (gauss_energy(membrane, element, Ta[0], 0, h) + gauss_energy(membrane, element, Ta[1], 1, h) +
          gauss_energy(membrane, element, Ta[2], 2, h) + gauss_energy(membrane, element, Ta[3], 3, h));
}

// R (kPa x length) and the lower triangle of K (kPa).
struct ElementLinearization {
  double R[element_dofs];
  double K[tangent_entries];
};

// Gauss point q: adds to the rows of corner n and their columns of the corners m <= n.
template <int q, int n, int m>
KOKKOS_FORCEINLINE_FUNCTION void add_entries(const Mat2& row_1, const Mat2& row_2,
                                             ElementLinearization& out) {
  constexpr ShapeGradient d = shape_gradient(m, gauss_coordinate(q % 2), gauss_coordinate(q / 2), 1);
  out.K[tangent_entry(2 * n, 2 * m)] += row_1.m11 * d.d1 + row_1.m12 * d.d2;
  out.K[tangent_entry(2 * n + 1, 2 * m)] += row_2.m11 * d.d1 + row_2.m12 * d.d2;
  out.K[tangent_entry(2 * n + 1, 2 * m + 1)] += row_2.m21 * d.d1 + row_2.m22 * d.d2;
  if (m < n) out.K[tangent_entry(2 * n, 2 * m + 1)] += row_1.m21 * d.d1 + row_1.m22 * d.d2;
}

template <int q, int n>
KOKKOS_FORCEINLINE_FUNCTION void add_rows(const Mat2& P, const SpatialTangent& A, ElementLinearization& out) {
  constexpr ShapeGradient g = shape_gradient(n, gauss_coordinate(q % 2), gauss_coordinate(q / 2), 1);
  out.R[2 * n] += P.m11 * g.d1 + P.m12 * g.d2;
  out.R[2 * n + 1] += P.m21 * g.d1 + P.m22 * g.d2;
  // Psi_n,M A_iMjN of row i, at jN.
  const Mat2 row_1{g.d1 * A.a1111 + g.d2 * A.a1112, g.d1 * A.a1112 + g.d2 * A.a1212,
                   g.d1 * A.a1121 + g.d2 * A.a1221, g.d1 * A.a1122 + g.d2 * A.a1222};
  const Mat2 row_2{g.d1 * A.a1121 + g.d2 * A.a1122, g.d1 * A.a1221 + g.d2 * A.a1222,
                   g.d1 * A.a2121 + g.d2 * A.a2122, g.d1 * A.a2122 + g.d2 * A.a2222};
  add_entries<q, n, 0>(row_1, row_2, out);
  if constexpr (n > 0) add_entries<q, n, 1>(row_1, row_2, out);
  if constexpr (n > 1) add_entries<q, n, 2>(row_1, row_2, out);
  if constexpr (n > 2) add_entries<q, n, 3>(row_1, row_2, out);
}

// Gauss point q. With the gradients of the unit square h^2 cancels in K, and R keeps one factor h.
template <int q>
KOKKOS_FORCEINLINE_FUNCTION void add_gauss_point(const Membrane& membrane, const ElementNodes& element,
                                                 double Ta, double h, ElementLinearization& out) {
  constexpr double weight = 0.25;
  const Mat2 F = gauss_deformation_gradient(element, q, h);
  const EnergyDerivatives w = membrane_energy(membrane, Ta, F);
  const EnergyDerivatives weighted{
      .w_t = weight * w.w_t, .w_A = weight * w.w_A, .w_tA = weight * w.w_tA, .w_AA = weight * w.w_AA};
  const Mat2 P = first_piola_kirchhoff(weighted, F);
  const double dead = weight * membrane.load.dead;
  const Mat2 force{h * (P.m11 - dead), h * P.m12, h * P.m21, h * (P.m22 - dead)};
  const SpatialTangent A = spatial_tangent(weighted, F);
  add_rows<q, 0>(force, A, out);
  add_rows<q, 1>(force, A, out);
  add_rows<q, 2>(force, A, out);
  add_rows<q, 3>(force, A, out);
}

KOKKOS_FORCEINLINE_FUNCTION ElementLinearization linearize_element(const Membrane& membrane,
                                                                   const ElementNodes& element,
                                                                   const double (&Ta)[gauss_points],
                                                                   double h) {
  ElementLinearization out{};
  add_gauss_point<0>(membrane, element, Ta[0], h, out);
  add_gauss_point<1>(membrane, element, Ta[1], h, out);
  add_gauss_point<2>(membrane, element, Ta[2], h, out);
  add_gauss_point<3>(membrane, element, Ta[3], h, out);
  return out;
}

}  // namespace myowave::elastic
