// Where the membrane loses ellipticity.
#include "kernels/elastic/ellipticity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/elastic/assemble.hpp"
#include "kernels/elastic/element.hpp"
#include "solver/mechanics/ellipticity.hpp"
#include "tests/support/sheets.hpp"

namespace myowave {
namespace {

using elastic::Membrane;

elastic::SpatialTangent tangent(const Membrane& membrane, double Ta, const Mat2& F) {
  return elastic::spatial_tangent(elastic::membrane_energy(membrane, Ta, F), F);
}

double modulus(double Ta, const Mat2& F) { return elastic::least_acoustic_modulus(tangent({}, Ta, F)); }

Mat2 equibiaxial(double stretch) { return {stretch, 0, 0, stretch}; }

// The second derivatives of w: 8 (c1 + c2) along the wave, the shear modulus 2 (c1 + c2) across it.
TEST(Ellipticity, UndeformedSheetByHand) {
  EXPECT_NEAR(modulus(0, equibiaxial(1)), 16, 1e-12);
  EXPECT_NEAR(modulus(50, equibiaxial(1)), 64 - 50, 1e-12);
}

// Along the wave the modulus is w_aa - Ta/s with s w_aa = c1 (2 s + 6/s^2) + c2 (2 s^2 + 6/s) for
// stretches a = b = sqrt s. The least Ta of all s is where 4 - 24/s^3 + 24 s - 36/s^2 = 0, at s = 1.2648.
TEST(Ellipticity, NoEquibiaxialStateLosesItBelow60Point2) {
  double least_Ta = 1e300, at = 0;
  for (double s = 0.05; s < 20; s += 1e-4) {
    const double Ta = 2 * (2 * s + 6 / (s * s)) + 6 * (2 * s * s + 6 / s);
    if (Ta < least_Ta) {
      least_Ta = Ta;
      at = s;
    }
    EXPECT_GT(modulus(60.2, equibiaxial(std::sqrt(s))), 0) << "s = " << s;
  }
  EXPECT_NEAR(least_Ta, 60.2, 0.05);
  EXPECT_NEAR(at, 1.2648, 1e-3);
  EXPECT_GT(modulus(least_Ta - 1e-6, equibiaxial(std::sqrt(at))), 0);
  EXPECT_LT(modulus(least_Ta + 1e-6, equibiaxial(std::sqrt(at))), 0);
}

TEST(Ellipticity, DependsOnNeitherAxesNorLoad) {
  const auto turn = [](double angle, const Mat2& F) {
    const double c = std::cos(angle), s = std::sin(angle);
    return Mat2{c * F.m11 - s * F.m21, c * F.m12 - s * F.m22, s * F.m11 + c * F.m21, s * F.m12 + c * F.m22};
  };
  const auto transposed = [](const Mat2& F) { return Mat2{F.m11, F.m21, F.m12, F.m22}; };
  const Mat2 F{1.1, 0.35, -0.2, 0.8};
  const double expected = modulus(30, F);
  for (const double angle : {0.3, 1.0, 2.5}) {
    EXPECT_NEAR(modulus(30, turn(angle, F)), expected, 1e-6) << "axes in space";
    EXPECT_NEAR(modulus(30, transposed(turn(angle, transposed(F)))), expected, 1e-6) << "axes in the sheet";
  }
  const Membrane loaded{.passive = {}, .load = {.follower = -20, .dead = 7}};
  EXPECT_NEAR(elastic::least_acoustic_modulus(tangent(loaded, 30, F)), expected, 1e-12);
}

TEST(Ellipticity, NoDirectionOfAThousandIsLower) {
  test::Uniform uniform(1);
  for (int state = 0; state < 200; ++state) {
    const Mat2 F{uniform(0.5, 1.5), uniform(-0.4, 0.4), uniform(-0.4, 0.4), uniform(0.5, 1.5)};
    const auto A = tangent({}, uniform(0, 100), F);
    double least = 1e300;
    for (int n = 0; n < 1000; ++n)
      least = std::min(least, elastic::acoustic_modulus(A, n * std::numbers::pi / 1000));
    EXPECT_LE(elastic::least_acoustic_modulus(A), least + 1e-6);
    EXPECT_NEAR(elastic::least_acoustic_modulus(A), least, 0.01 * std::abs(least) + 0.01);
  }
}

TEST(Ellipticity, TheExactCriterionIsTheSignOfTheLeastModulus) {
  test::Uniform uniform(2);
  int lost = 0;
  for (int state = 0; state < 5000; ++state) {
    const Mat2 F{uniform(0.4, 1.8), uniform(-0.6, 0.6), uniform(-0.6, 0.6), uniform(0.4, 1.8)};
    if (determinant(F) < 0.05) continue;
    const double Ta = uniform(0, 120), least = modulus(Ta, F);
    const Membrane loaded{.passive = {}, .load = {.follower = uniform(-30, 45), .dead = 0}};
    const bool elliptic = elastic::is_elliptic(elastic::membrane_energy(loaded, Ta, F), F);
    if (std::abs(least) > 1e-4) {
      EXPECT_EQ(elliptic, least > 0) << "least modulus " << least << " kPa";
    }
    lost += elliptic ? 0 : 1;
  }
  EXPECT_GT(lost, 200);
  EXPECT_LT(lost, 4800);
}

TEST(EllipticityMargin, AUniformSheetAtTheWeakestStretchLosesItAt60Point2) {
  const elastic::ElementGrid grid{.rows = 2, .columns = 3, .h = 6};
  const Nodes<Kokkos::HostSpace> nodes("nodes", grid.nodes());
  const Kokkos::DefaultHostExecutionSpace host;
  elastic::place_uniform(host, grid, std::sqrt(1.2648), nodes);
  const GaussTension<Kokkos::HostSpace> Ta("Ta", grid.elements());
  Kokkos::deep_copy(Ta, 60.1);
  EXPECT_GT(solver::ellipticity_margin(grid, {}, nodes, Ta), 0);
  EXPECT_EQ(elastic::count_not_elliptic(host, {}, grid, nodes, Ta), 0);
  Kokkos::deep_copy(Ta, 60.4);
  EXPECT_LT(solver::ellipticity_margin(grid, {}, nodes, Ta), 0);
  EXPECT_EQ(elastic::count_not_elliptic(host, {}, grid, nodes, Ta), 4 * grid.elements());
}

TEST(EllipticityMargin, IsOneUndeformedAndTakesTheWeakestGaussPoint) {
  const elastic::ElementGrid grid{.rows = 3, .columns = 4, .h = 6};
  const auto nodes = test::rough_nodes<Kokkos::HostSpace>(grid, 0, 1);
  const GaussTension<Kokkos::HostSpace> Ta("Ta", grid.elements());
  EXPECT_NEAR(solver::ellipticity_margin(grid, {}, nodes, Ta), 1, 1e-12);
  Ta(7, 2) = 72;
  EXPECT_NEAR(solver::ellipticity_margin(grid, {}, nodes, Ta), (64.0 - 72) / 16, 1e-9);
}

}  // namespace
}  // namespace myowave
