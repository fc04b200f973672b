// What a launch of several steps need not take (kernels/tissue/active_box.hpp). That it changes no bit to
// leave it out is tested with the launches (tiled_step.cpp).
#include "kernels/tissue/active_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "kernels/tissue/tiled_step.hpp"

namespace myowave::tissue {
namespace {

constexpr Grid grid{40, 60};
constexpr int depth = 7, line = 8;
constexpr double k_Ta = 50;

template <class Real>
using View = EnsembleField<Real, Kokkos::HostSpace>;

template <class Real>
ExcitationFields<View<Real>> at_rest(int members = 2) {
  return {View<Real>("V", members, grid.rows, grid.columns),
          View<Real>("r", members, grid.rows, grid.columns),
          View<Real>("Ta", members, grid.rows, grid.columns)};
}

std::array<int, 4> sides(const NodeBox& box) {
  return {box.first_row, box.last_row, box.first_column, box.last_column};
}

// With all that `depth` steps can reach, from a line's first column on.
std::array<int, 4> around(int i, int j) {
  return {std::max(0, i - depth), std::min(grid.rows, i + depth + 1), std::max(0, j - depth) / line * line,
          std::min(grid.columns, j + depth + 1)};
}

TEST(ActiveBox, HoldsEveryNodeOfEitherStateThatDoesNotRest) {
  for (const auto& [i, j] : {std::array{0, 0}, {39, 59}, {0, 59}, {39, 0}, {20, 31}, {8, 15}, {31, 0}})
    for (int field = 0; field < 6; ++field) {
      const auto state = at_rest<double>(), spare = at_rest<double>();
      const std::array fields{state.V, state.r, state.Ta, spare.V, spare.r, spare.Ta};
      fields[field](field % 2, i, j) = 1e-300;
      ActiveBox<double> active(grid, 0, k_Ta);
      EXPECT_EQ(sides(active.find(state, spare, depth, line)), around(i, j)) << i << ' ' << j << ' ' << field;
    }
}

TEST(ActiveBox, IsEmptyInASheetAtRestAndTheSheetWhereNothingRests) {
  const auto state = at_rest<float>(), spare = at_rest<float>();
  ActiveBox<float> active(grid, 0, k_Ta);
  EXPECT_EQ(active.find(state, spare, depth, line).rows(), 0);
  active.forget();
  Kokkos::deep_copy(spare.r, 1e-30F);
  EXPECT_EQ(sides(active.find(state, spare, depth, line)), sides(whole(grid)));
}

TEST(ActiveBox, IsTheUnionOfTwoFronts) {
  const auto state = at_rest<float>(), spare = at_rest<float>();
  state.V(0, 12, 20) = 1;
  state.V(1, 25, 40) = 1;
  ActiveBox<float> active(grid, 0, k_Ta);
  EXPECT_EQ(sides(active.find(state, spare, depth, line)), (std::array{5, 33, 8, 48}));
}

// Nothing gets out of a box in the steps of a launch, so that only its rim is looked at again.
TEST(ActiveBox, FollowsAFrontFromLaunchToLaunch) {
  const auto state = at_rest<double>(), spare = at_rest<double>();
  ActiveBox<double> active(grid, 0, k_Ta);
  for (int j = 10; j < 50; ++j) {
    Kokkos::deep_copy(state.V, 0);
    state.V(1, 20, j) = 1;
    EXPECT_EQ(sides(active.find(state, spare, depth, line)), around(20, j));
  }
  state.V(0, 0, 0) = 1;  // other than by steps
  EXPECT_EQ(sides(active.find(state, spare, depth, line)), around(20, 49));
  active.forget();
  EXPECT_EQ(sides(active.find(state, spare, depth, line)), (std::array{0, 28, 0, 57}));
}

template <class Real>
bool rests(double tolerance, Real V, Real Ta) {
  const auto state = at_rest<Real>(1), spare = at_rest<Real>(1);
  state.V(0, 20, 30) = V;
  state.Ta(0, 20, 30) = Ta;
  return ActiveBox<Real>(grid, tolerance, k_Ta).find(state, spare, depth, line).rows() == 0;
}

template <class Real>
void expect_tolerance() {
  using Limits = std::numeric_limits<Real>;
  // A step makes +0 of each of the first two, whether or not denormal numbers are flushed; not of +0.
  for (const Real V : {-Real(0), Limits::denorm_min(), Limits::min(), -Limits::min(), Limits::quiet_NaN(),
                       Limits::infinity()})
    EXPECT_FALSE(rests<Real>(0, V, 0)) << V;
  EXPECT_TRUE(rests<Real>(0, 0, 0));

  for (const Real V : {Real(1e-6), Real(-0.9e-6), -Real(0), Limits::denorm_min()}) {
    EXPECT_TRUE(rests<Real>(1e-6, V, 0)) << V;
    EXPECT_TRUE(rests<Real>(1e-6, 0, Real(k_Ta) * V)) << V;
  }
  for (const Real V : {Real(1.1e-6), Real(-1.1e-6), Limits::quiet_NaN()}) {
    EXPECT_FALSE(rests<Real>(1e-6, V, 0)) << V;
    EXPECT_FALSE(rests<Real>(1e-6, 0, Real(k_Ta) * V)) << V;
  }
}

TEST(ActiveBox, WithoutAToleranceOnlyPlusZeroRests) {
  expect_tolerance<double>();
  expect_tolerance<float>();
}

TEST(ActiveBox, NeedsNoTension) {
  auto state = at_rest<double>(), spare = at_rest<double>();
  state.Ta = spare.Ta = {};
  state.r(1, 20, 30) = 1;
  ActiveBox<double> active(grid, 0, k_Ta);
  EXPECT_EQ(sides(active.find(state, spare, depth, line)), around(20, 30));
}

}  // namespace
}  // namespace myowave::tissue
