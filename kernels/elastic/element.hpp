// Energy, residual and tangent of one element (Nash & Panfilov 2004, Eqs 15-19), 2 x 2 Gauss points:
//
//   Pi      = sum_g w_g [w + Ta ln J - p J]                                     (dead load: - p tr F)
//   R_(n,i) = sum_g w_g P_iM Psi_n,M                  P = F S                   (dead load: - p I)
//   K_(n,i)(m,j) = sum_g w_g Psi_n,M A_iMjN Psi_m,N   A_iMjN = F_iP dS_PM/dE_QN F_jQ + delta_ij S_MN
//
// One potential: R is its gradient and K its symmetric second derivative, for either load.
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

KOKKOS_INLINE_FUNCTION EnergyDerivatives membrane_energy(const Membrane& membrane, double Ta, const Sym2& C) {
  const double A = determinant(C);
  EnergyDerivatives w = passive_energy(membrane.passive, trace(C), A);
  add_active_tension(Ta, A, w);
  add_follower_load(membrane.load.follower, A, w);
  return w;
}

// P = dw/dF, first Piola-Kirchhoff stress with the load in it.
KOKKOS_INLINE_FUNCTION Mat2 first_piola_kirchhoff(const Membrane& membrane, const Mat2& F, const Sym2& S) {
  const double dead = membrane.load.dead;
  return {F.m11 * S.m11 + F.m12 * S.m12 - dead, F.m11 * S.m12 + F.m12 * S.m22, F.m21 * S.m11 + F.m22 * S.m12,
          F.m21 * S.m12 + F.m22 * S.m22 - dead};
}

// A_(iM)(jN) = dP_iM/dF_jN, rows and columns in the order 11, 12, 21, 22; symmetric.
struct SpatialTangent {
  double a[4][4];
};

KOKKOS_INLINE_FUNCTION SpatialTangent spatial_tangent(const Mat2& F, const Sym2& S,
                                                      const MaterialTangent& D) {
  // dE in the order 11, 22, 2 x 12 for a unit dF_iM.
  const double b[4][3] = {{F.m11, 0, F.m12}, {0, F.m12, F.m11}, {F.m21, 0, F.m22}, {0, F.m22, F.m21}};
  SpatialTangent A;
  for (int k = 0; k < 4; ++k) {
    const double s11 = D.d1111 * b[k][0] + D.d1122 * b[k][1] + D.d1112 * b[k][2];
    const double s22 = D.d1122 * b[k][0] + D.d2222 * b[k][1] + D.d2212 * b[k][2];
    const double s12 = D.d1112 * b[k][0] + D.d2212 * b[k][1] + D.d1212 * b[k][2];
    for (int l = 0; l < 4; ++l) A.a[k][l] = b[l][0] * s11 + b[l][1] * s22 + b[l][2] * s12;
  }
  for (int i = 0; i < 4; i += 2) {
    A.a[i][i] += S.m11;
    A.a[i][i + 1] += S.m12;
    A.a[i + 1][i] += S.m12;
    A.a[i + 1][i + 1] += S.m22;
  }
  return A;
}

// Pi of the element, kPa x area. Ta at its four Gauss points, kPa. J must be positive.
KOKKOS_INLINE_FUNCTION double element_energy(const Membrane& membrane, const ElementNodes& element,
                                             const double (&Ta)[gauss_points], double h) {
  double energy = 0;
  for (int q = 0; q < gauss_points; ++q) {
    const Mat2 F = gauss_deformation_gradient(element, q, h);
    energy +=
        membrane_energy(membrane, Ta[q], right_cauchy_green(F)).w - membrane.load.dead * (F.m11 + F.m22);
  }
  return 0.25 * h * h * energy;
}

// R (kPa x length) and the lower triangle of K (kPa).
struct ElementLinearization {
  double R[element_dofs];
  double K[tangent_entries];
};

// Adds Gauss point q.
KOKKOS_INLINE_FUNCTION void add_gauss_point(const Membrane& membrane, const ElementNodes& element, double Ta,
                                            int q, double h, ElementLinearization& out) {
  const Mat2 F = gauss_deformation_gradient(element, q, h);
  const Sym2 C = right_cauchy_green(F);
  const EnergyDerivatives w = membrane_energy(membrane, Ta, C);
  const Sym2 S = second_piola_kirchhoff(w, C);
  const Mat2 P = first_piola_kirchhoff(membrane, F, S);
  const SpatialTangent A = spatial_tangent(F, S, material_tangent(w, C));
  const double weight = 0.25 * h * h;

  ShapeGradient gradient[corners];
  for (int c = 0; c < corners; ++c) {
    gradient[c] = shape_gradient(c, gauss_coordinate(q % 2), gauss_coordinate(q / 2), h);
  }
  for (int n = 0; n < corners; ++n) {
    const double g1 = weight * gradient[n].d1, g2 = weight * gradient[n].d2;
    out.R[2 * n] += P.m11 * g1 + P.m12 * g2;
    out.R[2 * n + 1] += P.m21 * g1 + P.m22 * g2;
    // Row (n, i) of weight Psi_n,M A_iMjN, columns jN.
    double row[2][4];
    for (int k = 0; k < 4; ++k) {
      row[0][k] = g1 * A.a[0][k] + g2 * A.a[1][k];
      row[1][k] = g1 * A.a[2][k] + g2 * A.a[3][k];
    }
    for (int m = 0; m <= n; ++m) {
      const double d1 = gradient[m].d1, d2 = gradient[m].d2;
      out.K[tangent_entry(2 * n, 2 * m)] += row[0][0] * d1 + row[0][1] * d2;
      out.K[tangent_entry(2 * n + 1, 2 * m)] += row[1][0] * d1 + row[1][1] * d2;
      out.K[tangent_entry(2 * n + 1, 2 * m + 1)] += row[1][2] * d1 + row[1][3] * d2;
      if (m < n) out.K[tangent_entry(2 * n, 2 * m + 1)] += row[0][2] * d1 + row[0][3] * d2;
    }
  }
}

KOKKOS_INLINE_FUNCTION ElementLinearization linearize_element(const Membrane& membrane,
                                                              const ElementNodes& element,
                                                              const double (&Ta)[gauss_points], double h) {
  ElementLinearization out{};
  for (int q = 0; q < gauss_points; ++q) add_gauss_point(membrane, element, Ta[q], q, h, out);
  return out;
}

}  // namespace myowave::elastic
