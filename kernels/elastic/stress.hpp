// Stress and tangent of an isotropic plane energy w(t, A), t = F:F = tr C, A = J^2 = det C
// (Nash & Panfilov 2004, Eqs 9-12, reduced to the plane), per unit undeformed area:
//
//   P_iM     = dw/dF_iM = 2 w_t F_iM + 2 J w_A c_iM                       c = dJ/dF = cof F
//   A_iMjN   = dP_iM/dF_jN
//            = 2 w_t delta_ij delta_MN + (4 A w_AA + 2 w_A) c_iM c_jN
//              + 4 J w_tA (F_iM c_jN + c_iM F_jN) + 2 J w_A dc_iM/dF_jN
//
// The form with S = F^-1 P and C^-1, F_iP dS_PM/dE_QN F_jQ + delta_ij S_MN, is equal and needs more
// operations. w_tt = 0 for every term of this membrane, so it is omitted.
#pragma once

#include "kernels/base/tensor2.hpp"

namespace myowave::elastic {

// w (kPa) and its derivatives. Passive law, active tension and edge load each add their part.
struct EnergyDerivatives {
  double w = 0, w_t = 0, w_A = 0, w_tA = 0, w_AA = 0;
};

// P, first Piola-Kirchhoff.
KOKKOS_FORCEINLINE_FUNCTION constexpr Mat2 first_piola_kirchhoff(const EnergyDerivatives& w, const Mat2& F) {
  const double along_F = 2 * w.w_t, along_c = 2 * determinant(F) * w.w_A;
  return {along_F * F.m11 + along_c * F.m22, along_F * F.m12 - along_c * F.m21,
          along_F * F.m21 - along_c * F.m12, along_F * F.m22 + along_c * F.m11};
}

// A_iMjN at a iMjN. Symmetric: A_iMjN = A_jNiM.
struct SpatialTangent {
  double a1111, a1112, a1121, a1122, a1212, a1221, a1222, a2121, a2122, a2222;
};

KOKKOS_FORCEINLINE_FUNCTION constexpr SpatialTangent spatial_tangent(const EnergyDerivatives& w,
                                                                     const Mat2& F) {
  const double J = determinant(F);
  const double diagonal = 2 * w.w_t, squared = 4 * J * J * w.w_AA + 2 * w.w_A, mixed = 4 * J * w.w_tA,
               crossed = 2 * J * w.w_A;
  const Mat2 c{F.m22, -F.m21, -F.m12, F.m11};
  // A_k. = mixed c_k F_. + (squared c_k + mixed F_k) c_. + ...
  const Mat2 f{mixed * c.m11, mixed * c.m12, mixed * c.m21, mixed * c.m22};
  const Mat2 s{squared * c.m11 + mixed * F.m11, squared * c.m12 + mixed * F.m12,
               squared * c.m21 + mixed * F.m21, squared * c.m22 + mixed * F.m22};
  return {diagonal + f.m11 * F.m11 + s.m11 * c.m11,
          f.m11 * F.m12 + s.m11 * c.m12,
          f.m11 * F.m21 + s.m11 * c.m21,
          crossed + f.m11 * F.m22 + s.m11 * c.m22,
          diagonal + f.m12 * F.m12 + s.m12 * c.m12,
          f.m12 * F.m21 + s.m12 * c.m21 - crossed,
          f.m12 * F.m22 + s.m12 * c.m22,
          diagonal + f.m21 * F.m21 + s.m21 * c.m21,
          f.m21 * F.m22 + s.m21 * c.m22,
          diagonal + f.m22 * F.m22 + s.m22 * c.m22};
}

}  // namespace myowave::elastic
