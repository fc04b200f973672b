#include "solver/base/root_finding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace myowave::solver {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Bisect, WithoutToleranceEndsBetweenNeighbouringNumbers) {
  const auto below = [](double x) { return x * x < 2; };
  const Bracket root = bisect({0, 8}, 0, below);
  EXPECT_TRUE(below(root.low));
  EXPECT_FALSE(below(root.high));
  EXPECT_EQ(std::nextafter(root.low, infinity), root.high);
}

TEST(Bisect, StopsAtItsTolerance) {
  const Bracket root = bisect({0, 1}, 1e-3, [](double x) { return x < 0.3; });
  EXPECT_EQ(root.high - root.low, std::ldexp(1, -10));
  EXPECT_LE(root.low, 0.3);
  EXPECT_GE(root.high, 0.3);
}

TEST(Bisect, WithoutASignChangeShrinksToOneEnd) {
  EXPECT_LT(bisect({0, 4}, 1e-9, [](double) { return false; }).high, 1e-9);
  EXPECT_GT(bisect({0, 4}, 1e-9, [](double) { return true; }).low, 4 - 1e-9);
}

TEST(Bisect, AnEmptyIntervalIsReturnedAndAReversedOneIsAnError) {
  const auto below = [](double x) { return x < 1; };
  EXPECT_EQ(bisect({2, 2}, 0, below).middle(), 2);
  EXPECT_THROW(bisect({3, 2}, 0, below), std::invalid_argument);
}

}  // namespace
}  // namespace myowave::solver
