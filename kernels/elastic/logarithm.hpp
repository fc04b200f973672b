// The logarithm in operations that vectorise; the library function is one call a lane.
//
//   x = 2^k m, m in [1/sqrt 2, sqrt 2):  ln x = k ln 2 + 2 artanh z,  z = (m - 1)/(m + 1)
//   artanh z = z (1 + z^2/3 + z^4/5 + ...)
//
// z^2 <= 0.0295, so the first omitted term, z^22/23, is below 1e-18.
#pragma once

#include <Kokkos_Core.hpp>
#include <cstdint>

namespace myowave::elastic {

// ln x to about the rounding error of the result; x positive, finite, not denormal.
KOKKOS_FORCEINLINE_FUNCTION double natural_logarithm(double x) {
  constexpr double ln_2 = 0.693147180559945309417;
  constexpr int mantissa_bits = 52;
  constexpr std::int64_t inv_sqrt_2 = 0x3fe6a09e667f3bcd;  // the bits of 1/sqrt 2
  const auto bits = Kokkos::bit_cast<std::int64_t>(x);
  const std::int64_t k = (bits - inv_sqrt_2) >> mantissa_bits;
  const auto m = Kokkos::bit_cast<double>(bits - k * (std::int64_t{1} << mantissa_bits));
  const double z = (m - 1) / (m + 1), y = z * z;
  double series = 1.0 / 21;
  series = series * y + 1.0 / 19;
  series = series * y + 1.0 / 17;
  series = series * y + 1.0 / 15;
  series = series * y + 1.0 / 13;
  series = series * y + 1.0 / 11;
  series = series * y + 1.0 / 9;
  series = series * y + 1.0 / 7;
  series = series * y + 1.0 / 5;
  series = series * y + 1.0 / 3;
  const auto power = static_cast<double>(k);
  return power * ln_2 + 2 * (z + z * y * series);
}

}  // namespace myowave::elastic
