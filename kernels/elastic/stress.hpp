// Stress and tangent of an isotropic plane energy w(t, A), t = tr C, A = det C = J^2
// (Nash & Panfilov 2004, Eqs 9-12, reduced to the plane), per unit undeformed area:
//
//   S     = 2 w_t I + 2 A w_A C^-1
//   dS/dE = 4 [A w_tA (I x C^-1 + C^-1 x I) + (A^2 w_AA + A w_A) C^-1 x C^-1 - A w_A II]
//   II_MNPQ = 1/2 (C^-1_MP C^-1_NQ + C^-1_MQ C^-1_NP)
//
// w_tt = 0 in every term of this membrane, and is left out.
#pragma once

#include "kernels/base/tensor2.hpp"

namespace myowave::elastic {

// w (kPa) and its derivatives. Passive law, active tension and edge load each add their part.
struct EnergyDerivatives {
  double w = 0, w_t = 0, w_A = 0, w_tA = 0, w_AA = 0;
};

// dS/dE in the order 11, 22, 12: dS = D (dE_11, dE_22, 2 dE_12). Symmetric.
struct MaterialTangent {
  double d1111, d1122, d1112, d2222, d2212, d1212;
};

KOKKOS_INLINE_FUNCTION constexpr Sym2 second_piola_kirchhoff(const EnergyDerivatives& w, const Sym2& C) {
  const Sym2 g = inverse(C);
  const double along_I = 2 * w.w_t;
  const double along_g = 2 * determinant(C) * w.w_A;
  return {along_I + along_g * g.m11, along_g * g.m12, along_I + along_g * g.m22};
}

KOKKOS_INLINE_FUNCTION constexpr MaterialTangent material_tangent(const EnergyDerivatives& w, const Sym2& C) {
  const Sym2 g = inverse(C);
  const double A = determinant(C);
  const double mixed = 4 * A * w.w_tA;
  const double squared = 4 * (A * A * w.w_AA + A * w.w_A);
  const double fourth = -4 * A * w.w_A;
  return {2 * mixed * g.m11 + (squared + fourth) * g.m11 * g.m11,
          mixed * (g.m11 + g.m22) + squared * g.m11 * g.m22 + fourth * g.m12 * g.m12,
          mixed * g.m12 + (squared + fourth) * g.m11 * g.m12,
          2 * mixed * g.m22 + (squared + fourth) * g.m22 * g.m22,
          mixed * g.m12 + (squared + fourth) * g.m22 * g.m12,
          squared * g.m12 * g.m12 + 0.5 * fourth * (g.m11 * g.m22 + g.m12 * g.m12)};
}

}  // namespace myowave::elastic
