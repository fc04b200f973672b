#include <gtest/gtest.h>

#include "kernels/elastic/kinematics.hpp"

namespace myowave::elastic {
namespace {

TEST(Kinematics, AffineMapHasItsMatrixEverywhere) {
  const Mat2 F{1.2, -0.3, 0.4, 0.9};
  const double h = 6;
  ElementNodes element{};
  for (int c = 0; c < corners; ++c) {
    const double X1 = h * (c % 2), X2 = h * (c / 2);
    element.x[c][0] = 5 + F.m11 * X1 + F.m12 * X2;
    element.x[c][1] = -7 + F.m21 * X1 + F.m22 * X2;
  }
  for (int q = 0; q < gauss_points; ++q) {
    const Mat2 found = gauss_deformation_gradient(element, q, h);
    EXPECT_NEAR(found.m11, F.m11, 1e-15);
    EXPECT_NEAR(found.m12, F.m12, 1e-15);
    EXPECT_NEAR(found.m21, F.m21, 1e-15);
    EXPECT_NEAR(found.m22, F.m22, 1e-15);
  }
  EXPECT_NEAR(min_corner_J(element, h), determinant(F), 1e-14);
}

TEST(Kinematics, DeformationGradientIsTheSumOverShapeGradients) {
  const double h = 2.5;
  const ElementNodes element{{{0.1, -0.2}, {2.8, 0.3}, {-0.4, 2.1}, {2.2, 3.0}}};
  for (int q = 0; q < gauss_points; ++q) {
    double F[2][2] = {};
    for (int c = 0; c < corners; ++c) {
      const auto gradient = shape_gradient(c, gauss_coordinate(q % 2), gauss_coordinate(q / 2), h);
      for (int i = 0; i < 2; ++i) {
        F[i][0] += element.x[c][i] * gradient.d1;
        F[i][1] += element.x[c][i] * gradient.d2;
      }
    }
    const Mat2 found = gauss_deformation_gradient(element, q, h);
    EXPECT_NEAR(found.m11, F[0][0], 1e-15);
    EXPECT_NEAR(found.m12, F[0][1], 1e-15);
    EXPECT_NEAR(found.m21, F[1][0], 1e-15);
    EXPECT_NEAR(found.m22, F[1][1], 1e-15);
  }
}

// Corner (1, 1) pulled past the diagonal from (0, 1) to (1, 0): inverted there, not at any Gauss point.
TEST(Kinematics, InvertedCornerIsSeenWhereEveryGaussPointIsNot) {
  const ElementNodes element{{{0, 0}, {1, 0}, {0, 1}, {0.45, 0.45}}};
  for (int q = 0; q < gauss_points; ++q) {
    EXPECT_GT(determinant(gauss_deformation_gradient(element, q, 1)), 0);
  }
  EXPECT_NEAR(min_corner_J(element, 1), 0.45 + 0.45 - 1, 1e-15);
}

TEST(Kinematics, CornersOfAnElementInTheMesh) {
  const ElementGrid grid{.rows = 2, .columns = 3, .h = 1};
  EXPECT_EQ(grid.corner(4, 0), 5);
  EXPECT_EQ(grid.corner(4, 1), 6);
  EXPECT_EQ(grid.corner(4, 2), 9);
  EXPECT_EQ(grid.corner(4, 3), 10);
}

}  // namespace
}  // namespace myowave::elastic
