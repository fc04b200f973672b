// Active tension (Nash & Panfilov 2004, Eq 21), in the plane of the sheet only:
//
//   S_active = Ta C^-1,   the derivative of the potential Ta ln J = (Ta/2) ln A
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/elastic/logarithm.hpp"
#include "kernels/elastic/stress.hpp"

namespace myowave::elastic {

// Adds the potential of the tension Ta (kPa) at A = det C.
KOKKOS_FORCEINLINE_FUNCTION void add_active_tension(double Ta, double A, EnergyDerivatives& w) {
  w.w += 0.5 * Ta * natural_logarithm(A);
  const double inv_A = 1 / A;
  w.w_A += 0.5 * Ta * inv_A;
  w.w_AA -= 0.5 * Ta * inv_A * inv_A;
}

}  // namespace myowave::elastic
