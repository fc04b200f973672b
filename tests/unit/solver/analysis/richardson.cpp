#include "solver/analysis/richardson.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace myowave::solver {
namespace {

TEST(Richardson, FindsOrderAndLimitOnUnequalRatios) {
  for (const double p : {0.5, 1.0, 2.0, 3.7}) {
    for (const auto& h : {std::vector{1 / 2., 1 / 3., 1 / 4.}, std::vector{1., 0.5, 0.1}}) {
      std::vector<double> values;
      for (const double one : h) values.push_back(1.535 - 0.2 * std::pow(one, p));
      const Extrapolated limit = richardson(h, values);
      ASSERT_TRUE(limit.order);
      EXPECT_NEAR(*limit.order, p, 1e-8);
      EXPECT_NEAR(limit.value, 1.535, 1e-10);
      EXPECT_NEAR(limit.uncertainty, 0.2 * std::pow(h.back(), p), 1e-9);
    }
  }
}

TEST(Richardson, TakesTheFinestGridWhereThereIsNoOrder) {
  const std::vector<double> h{1 / 2., 1 / 3., 1 / 4.};
  for (const auto& values :
       {std::vector{1., 2., 1.5}, std::vector{1., 1.01, 1.51}, std::vector{2., 2., 1.5}}) {
    const Extrapolated limit = richardson(h, values);
    EXPECT_FALSE(limit.order);
    EXPECT_EQ(limit.value, values[2]);
    EXPECT_DOUBLE_EQ(limit.uncertainty, std::abs(values[2] - values[1]));
  }
  EXPECT_FALSE(richardson(h, std::vector{1 + 4e-10, 1 + 2e-10, 1.}).order) << "rounding has no order";
  EXPECT_EQ(richardson(std::vector{1., 0.5}, std::vector{3., 4.}).uncertainty, 1);
  EXPECT_TRUE(std::isnan(richardson(std::vector{1.}, std::vector{3.}).uncertainty));
}

}  // namespace
}  // namespace myowave::solver
