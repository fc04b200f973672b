#include "kernels/base/tensor2.hpp"

#include <gtest/gtest.h>

namespace myowave {
namespace {

TEST(Tensor2, RightCauchyGreenOfAHandCase) {
  const Mat2 F{2, 1, 0, 3};
  const Sym2 C = right_cauchy_green(F);
  EXPECT_DOUBLE_EQ(C.m11, 4);
  EXPECT_DOUBLE_EQ(C.m12, 2);
  EXPECT_DOUBLE_EQ(C.m22, 10);
  EXPECT_DOUBLE_EQ(determinant(C), determinant(F) * determinant(F));
  const Sym2 inv = inverse(C);
  EXPECT_NEAR(C.m11 * inv.m11 + C.m12 * inv.m12, 1, 1e-15);
  EXPECT_NEAR(C.m11 * inv.m12 + C.m12 * inv.m22, 0, 1e-15);
}

}  // namespace
}  // namespace myowave
