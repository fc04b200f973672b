// The passive membrane: an incompressible Mooney-Rivlin sheet in plane stress
// (Nash & Panfilov 2004, Eqs 13-14, with C_33 = 1/det C and the pressure eliminated by T_33 = 0).
//
//   w = c1 (t + 1/A) + c2 (A + t/A)
//
// The paper prints no pressure term. Without one the undeformed sheet would not be free of stress; with the
// membrane closure S = 0 at C = I.
#pragma once

#include "kernels/elastic/parameters.hpp"
#include "kernels/elastic/stress.hpp"

namespace myowave::elastic {

KOKKOS_FORCEINLINE_FUNCTION constexpr EnergyDerivatives passive_energy(const MooneyRivlin& law, double t,
                                                                       double A) {
  const double inv_A = 1 / A;
  return {.w = law.c1 * (t + inv_A) + law.c2 * (A + t * inv_A),
          .w_t = law.c1 + law.c2 * inv_A,
          .w_A = -law.c1 * inv_A * inv_A + law.c2 * (1 - t * inv_A * inv_A),
          .w_tA = -law.c2 * inv_A * inv_A,
          .w_AA = 2 * (law.c1 + law.c2 * t) * inv_A * inv_A * inv_A};
}

}  // namespace myowave::elastic
