#include "solver/analysis/conduction_velocity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace myowave::solver {
namespace {

constexpr int rows = 17, columns = 23;
constexpr double dx = 0.6, nan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> velocity_of(const std::function<double(double, double)>& activation) {
  std::vector<double> T;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) T.push_back(activation(j * dx, i * dx));
  return conduction_velocity(rows, columns, dx, T);
}

TEST(ConductionVelocity, OfAPlaneFrontIsItsSpeedEverywhere) {
  for (const double angle : {0.0, 0.4, 1.5707963, 2.5}) {
    const auto velocity = velocity_of(
        [&](double x, double y) { return 100 + (std::cos(angle) * x + std::sin(angle) * y) / 1.535; });
    for (const double c : velocity) EXPECT_NEAR(c, 1.535, 1e-9);
  }
}

TEST(ConductionVelocity, FrontsThatCollideHaveNoneWhereTheyMeet) {
  const auto velocity = velocity_of([](double x, double) { return 50 - std::abs(x - 11 * dx) / 1.5; });
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double c = velocity[i * columns + j];
      if (j == 11) {
        EXPECT_TRUE(std::isnan(c));
      } else {
        EXPECT_NEAR(c, 1.5, 1e-9) << i << ' ' << j;
      }
    }
}

TEST(ConductionVelocity, OfARingIsRadial) {
  const auto velocity =
      velocity_of([](double x, double y) { return std::hypot(x - 11 * dx, y - 8 * dx) / 1.2; });
  EXPECT_TRUE(std::isnan(velocity[8 * columns + 11])) << "it starts there";
  for (int i = 1; i < rows - 1; ++i)
    for (int j = 1; j < columns - 1; ++j)
      if (std::hypot(i - 8, j - 11) > 4) {
        EXPECT_NEAR(velocity[i * columns + j], 1.2, 0.02) << i << ' ' << j;
      }
}

TEST(ConductionVelocity, AcrossBeatsAndMissingNodesThereIsNone) {
  const auto velocity = velocity_of([](double x, double y) {
    if (y == 0 && x == 0) return nan;
    return x / 1.5 + (x > 10.5 * dx ? 0 : 27.0);  // the front of the next beat is at column 10
  });
  for (int j : {9, 12}) EXPECT_NEAR(velocity[5 * columns + j], 1.5, 1e-9);
  for (int j : {10, 11}) EXPECT_TRUE(std::isnan(velocity[5 * columns + j]));
  for (int n : {0, 1, columns}) EXPECT_TRUE(std::isnan(velocity[n])) << "neighbours without activation time";
  EXPECT_NEAR(velocity[columns + 1], 1.5, 1e-9);
}

TEST(ConductionVelocity, OfASingleRowAndWithoutActivation) {
  const std::vector<double> row{0, 0.5, 1, 1.5};
  for (const double c : conduction_velocity(1, 4, dx, row)) EXPECT_NEAR(c, 1.2, 1e-12);
  const std::vector<double> at_once(4, 3.0);
  for (const double c : conduction_velocity(2, 2, dx, at_once)) EXPECT_TRUE(std::isnan(c));
}

TEST(Quartiles, OfAHandCase) {
  const Quartiles q = quartiles(std::vector<double>{4, nan, 1, 3, 2, 5});
  EXPECT_EQ(q.n, 5);
  EXPECT_EQ(q.lower, 2);
  EXPECT_EQ(q.median, 3);
  EXPECT_EQ(q.upper, 4);
  EXPECT_EQ(quartiles(std::vector<double>{1, 2}).median, 1.5);
  EXPECT_EQ(quartiles({}).n, 0);
  EXPECT_TRUE(std::isnan(quartiles({}).median));
}

}  // namespace
}  // namespace myowave::solver
