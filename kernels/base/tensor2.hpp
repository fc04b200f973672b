// Tensors of the plane, as plain values.
#pragma once

#include <Kokkos_Macros.hpp>

namespace myowave {

// A general 2x2 tensor, row index first: F.m12 = dx_1/dX_2.
struct Mat2 {
  double m11, m12, m21, m22;
};

// A symmetric 2x2 tensor.
struct Sym2 {
  double m11, m12, m22;
};

KOKKOS_INLINE_FUNCTION constexpr double determinant(const Mat2& F) { return F.m11 * F.m22 - F.m12 * F.m21; }
KOKKOS_INLINE_FUNCTION constexpr double determinant(const Sym2& C) { return C.m11 * C.m22 - C.m12 * C.m12; }
KOKKOS_INLINE_FUNCTION constexpr double trace(const Sym2& C) { return C.m11 + C.m22; }

// C = F^T F.
KOKKOS_INLINE_FUNCTION constexpr Sym2 right_cauchy_green(const Mat2& F) {
  return {F.m11 * F.m11 + F.m21 * F.m21, F.m11 * F.m12 + F.m21 * F.m22, F.m12 * F.m12 + F.m22 * F.m22};
}

KOKKOS_INLINE_FUNCTION constexpr Sym2 inverse(const Sym2& C) {
  const double d = 1.0 / determinant(C);
  return {d * C.m22, -d * C.m12, d * C.m11};
}

}  // namespace myowave
