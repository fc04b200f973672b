#include "solver/analysis/error_norms.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace myowave::solver {
namespace {

TEST(ErrorNorms, OfFieldsAreRelativeToTheReference) {
  EXPECT_DOUBLE_EQ(rms(std::vector{3., 4., 0., 0.}), 2.5);
  EXPECT_EQ(rms({}), 0);
  EXPECT_DOUBLE_EQ(*relative_l2(std::vector{3., 5.}, std::vector{0., 5.}), 0.6);
  EXPECT_FALSE(relative_l2(std::vector{1.}, std::vector{1., 2.})) << "other grid";
  EXPECT_FALSE(relative_l2(std::vector{1.}, std::vector{0.}));
  EXPECT_FALSE(relative_l2({}, {}));
}

TEST(ErrorNorms, InterpolateCubicsExactlyUpToTheEnds) {
  const auto cubic = [](double t) { return 1 - 2 * t + 3 * t * t - 0.5 * t * t * t; };
  const std::vector<double> times{0, 0.5, 1.5, 2, 3, 5};
  std::vector<double> values;
  for (const double t : times) values.push_back(cubic(t));
  for (const double t : {0., 0.2, 1., 1.7, 2.5, 4.9, 5.})
    EXPECT_NEAR(interpolate_cubic(times, values, t), cubic(t), 1e-12) << t;
  EXPECT_EQ(interpolate_cubic(std::vector{0., 2.}, std::vector{1., 5.}, 0.5), 2) << "linear between two";
}

TEST(ErrorNorms, TipsAreComparedWithTheNearestOfTheirCharge) {
  const std::vector<Tip> reference{{0, 0, 1}, {10, 0, -1}};
  EXPECT_DOUBLE_EQ(*tip_distance(std::vector<Tip>{{3, 4, 1}, {10, 1, -1}, {0, 1, -1}}, reference), 3);
  EXPECT_FALSE(tip_distance(std::vector<Tip>{{3, 4, 1}}, reference)) << "no tip has the other charge";
  EXPECT_FALSE(tip_distance({}, reference));
  EXPECT_FALSE(tip_distance(reference, {}));
}

}  // namespace
}  // namespace myowave::solver
