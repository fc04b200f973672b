// Nodes between two solves: weights against the known ones and polynomials, and what is never turned inside
// out.
#include "solver/coupling/node_history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "solver/base/lagrange.hpp"

namespace myowave::solver {
namespace {

using ::testing::DoubleEq;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using HostNodes = NodeHistory::HostNodes;

TEST(LagrangeWeights, OfEqualSpacings) {
  const std::array times{0.0, -1.0, -2.0};
  const auto weights = [&](std::size_t solves, double t) {
    return lagrange_weights(std::span(times).first(solves), t);
  };
  EXPECT_THAT(weights(1, 0.5), ElementsAre(1));
  EXPECT_THAT(weights(2, 0.5), ElementsAre(1.5, -0.5));
  EXPECT_THAT(weights(3, 0.5), ElementsAre(1.875, -1.25, 0.375));
  EXPECT_THAT(weights(2, 1.5), ElementsAre(2.5, -1.5));
  EXPECT_THAT(weights(3, 1.5), ElementsAre(4.375, -5.25, 1.875));
}

TEST(LagrangeWeights, AreExactForPolynomialsAtUnequalSpacings) {
  const std::array times{7.25, 4.0, 3.5};
  const double t = 8.125;
  const auto at = [&](std::size_t solves, const std::function<double(double)>& f) {
    double value = 0;
    const auto weights = lagrange_weights(std::span(times).first(solves), t);
    for (std::size_t n = 0; n < solves; ++n) value += weights[n] * f(times[n]);
    return value;
  };
  const auto line = [](double s) { return 2 - 3 * s; };
  const auto parabola = [](double s) { return 1 + s * (0.5 - 0.75 * s); };
  for (const std::size_t solves : {2, 3}) EXPECT_THAT(at(solves, line), DoubleNear(line(t), 1e-12));
  EXPECT_THAT(at(3, parabola), DoubleNear(parabola(t), 1e-12));
}

constexpr elastic::ElementGrid one_element{1, 1, 1};

// Corner (1, 1) at (q, q): J there is 2 q - 1, and positive at the Gauss points from q = 0.37 on.
HostNodes kite(double q) {
  HostNodes nodes("nodes", one_element.nodes());
  const std::array<double, 8> positions{0, 0, 1, 0, 0, 1, q, q};
  std::ranges::copy(positions, nodes.data());
  return nodes;
}

// At successive whole times, the last at t = 0.
NodeHistory solved(const std::vector<double>& q, std::size_t kept = NodeHistory::most_solves) {
  NodeHistory nodes(one_element, kept);
  for (std::size_t n = 0; n < q.size(); ++n)
    nodes.add(static_cast<double>(n) - static_cast<double>(q.size() - 1), kite(q[n]));
  return nodes;
}

double corner_at(NodeHistory nodes, double t) { return nodes.at(t)(3, 0); }

TEST(NodeHistory, FollowAsManySolvesAsAreKnownAndKept) {
  const auto parabola = [](double t) { return 1 + t * (0.125 + 0.0625 * t); };
  const std::vector<double> q{parabola(-3), parabola(-2), parabola(-1), parabola(0)};
  EXPECT_THAT(corner_at(solved(q), 0.5), DoubleEq(parabola(0.5)));
  EXPECT_THAT(corner_at(solved(q, 2), 0.5), DoubleEq(1.5 * q[3] - 0.5 * q[2]));
  EXPECT_EQ(corner_at(solved(q, 1), 0.5), q[3]);
  EXPECT_THAT(corner_at(solved({q[2], q[3]}), 0.5), DoubleEq(1.5 * q[3] - 0.5 * q[2]));
  EXPECT_EQ(corner_at(solved({q[3]}), 0.5), q[3]);
  EXPECT_EQ(solved(q).last()(3, 1), q[3]);
}

TEST(NodeHistory, ThatDoNotMoveAreBitwiseUnchanged) {
  EXPECT_EQ(corner_at(solved({1 / 3.0, 1.1, 1.1, 1.1}), 0.3), 1.1);
}

// Of the parabola, the line and the last nodes the first that turns no corner.
TEST(NodeHistory, TurnNoCorner) {
  EXPECT_THAT(corner_at(solved({1.2, 1, 0.9}), 0.5), DoubleEq(1.875 * 0.9 - 1.25 + 0.375 * 1.2));
  EXPECT_THAT(corner_at(solved({0.6, 1.2, 0.9}), 0.5), DoubleEq(1.5 * 0.9 - 0.5 * 1.2)) << "parabola: 0.41";
  EXPECT_EQ(corner_at(solved({1.3, 1.2, 0.7}), 0.5), 0.7) << "parabola: 0.3, line: 0.45";
  EXPECT_EQ(corner_at(solved({1.2, 0.7}), 0.5), 0.7) << "line: 0.45";
}

TEST(NodeHistory, ReportWhetherOneHasMoved) {
  NodeHistory nodes(one_element, 2);
  EXPECT_TRUE(nodes.empty());
  EXPECT_TRUE(nodes.add(0, kite(1)));
  EXPECT_FALSE(nodes.empty());
  EXPECT_FALSE(nodes.add(1, kite(1)));
  EXPECT_TRUE(nodes.add(2, kite(1.01)));
}

}  // namespace
}  // namespace myowave::solver
