#include "kernels/observe/state_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/fields.hpp"

namespace myowave::observe {
namespace {

using test::ExecutionSpace;
using test::Values;

template <class Function>
Values field(int rows, int columns, const Function& value) {
  Values V;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) V.push_back(value(i, j));
  return V;
}

double checkerboard(int i, int j) { return (i + j) % 2 == 0 ? 1 : -1; }

// Of V, with any r and no Ta.
template <class Real = double>
InspectedState range(int rows, int columns, const std::vector<Values>& members) {
  const auto V = test::to_view<Real>(rows, columns, members);
  return inspect_state(ExecutionSpace(), V, V, {});
}

// The plain loop: no code of the kernel, mirrored indices written out.
double plain_noise(int rows, int columns, const Values& V) {
  const auto at = [&](int i, int j) {
    const int row = i < 0 ? 1 : (i == rows ? rows - 2 : i),
              column = j < 0 ? 1 : (j == columns ? columns - 2 : j);
    return V[row * columns + column];
  };
  constexpr double weight[3] = {1, -2, 1};
  double largest = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      double sum = 0;
      for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b) sum += weight[a + 1] * weight[b + 1] * at(i + a, j + b);
      largest = std::max(largest, std::abs(sum) / 16);
    }
  return largest;
}

TEST(GridNoise, OfACheckerboardIsItsAmplitude) {
  for (const auto& [rows, columns] : {std::pair{2, 2}, {2, 7}, {3, 2}, {3, 3}, {13, 37}}) {
    const auto V = field(rows, columns, [](int i, int j) { return 0.4 + 0.25 * checkerboard(i, j); });
    const InspectedState found = range(rows, columns, {V});
    EXPECT_DOUBLE_EQ(found.noise, 0.25) << rows << " x " << columns;
    EXPECT_DOUBLE_EQ(found.min_V, 0.15);
    EXPECT_DOUBLE_EQ(found.max_V, 0.65);
  }
}

TEST(GridNoise, OfOneCoordinateAloneIsZero) {
  const auto jagged = [](int n) { return std::sin(40.0 * n); };
  EXPECT_NEAR(range(13, 37, {field(13, 37, [&](int i, int) { return jagged(i); })}).noise, 0, 1e-16);
  EXPECT_NEAR(range(13, 37, {field(13, 37, [&](int, int j) { return jagged(j); })}).noise, 0, 1e-16);
}

TEST(GridNoise, HandCases) {
  Values V(5 * 5, 0.0);
  V[2 * 5 + 2] = 1;  // one node, as a stimulus of radius 0 leaves it
  EXPECT_DOUBLE_EQ(range(5, 5, {V}).noise, 4.0 / 16);
  // the corner of a block, as at the start of a broken front
  EXPECT_DOUBLE_EQ(range(9, 9, {field(9, 9, [](int i, int j) { return i < 4 && j < 4 ? 1 : 0; })}).noise,
                   1.0 / 16);
}

// cos(q i) cos(q j) continues itself across mirrored edges; its noise is sin^4(q / 2).
TEST(GridNoise, OfAWaveFallsWithTheFourthPowerOfItsWavenumber) {
  constexpr int n = 61;
  for (const int half_waves : {2, 5, 10, 20, 60}) {
    const double q = half_waves * std::numbers::pi / (n - 1);
    const auto V = field(n, n, [&](int i, int j) { return std::cos(q * i) * std::cos(q * j); });
    EXPECT_NEAR(range(n, n, {V}).noise, std::pow(std::sin(q / 2), 4), 1e-13);
  }
}

TEST(GridNoise, EqualsThePlainLoopOnRoughFieldsOfSeveralMembers) {
  for (const auto& [rows, columns] : {std::pair{2, 3}, {13, 37}, {40, 65}}) {
    std::vector<Values> members;
    for (unsigned seed = 0; seed < 3; ++seed)
      members.push_back(test::random_field(rows * columns, -1.5, 2.5, seed));
    const InspectedState found = range(rows, columns, members),
                         in_floats = range<float>(rows, columns, members);
    double noise = 0, low = 9, high = -9;
    for (const auto& V : members) {
      noise = std::max(noise, plain_noise(rows, columns, V));
      low = std::min(low, *std::ranges::min_element(V));
      high = std::max(high, *std::ranges::max_element(V));
    }
    EXPECT_NEAR(found.noise, noise, 1e-14);
    EXPECT_EQ(found.min_V, low);
    EXPECT_EQ(found.max_V, high);
    EXPECT_NEAR(in_floats.noise, noise, 1e-5);
  }
}

// dV/dt = -lambda V on a checkerboard: each step multiplies it by 1 - lambda dt.
TEST(GrowingNoise, IsWhatAlternatesWithoutDecaying) {
  constexpr int rows = 12, columns = 17;
  constexpr double amplitude = 0.25, dt = 0.02;
  const auto V = field(rows, columns, [](int i, int j) { return 0.4 + amplitude * checkerboard(i, j); });
  const auto found = [&](double factor, double threshold) {
    const auto rate = field(rows, columns,
                            [&](int i, int j) { return (factor - 1) / dt * amplitude * checkerboard(i, j); });
    return growing_noise(ExecutionSpace(), test::to_view<double>(rows, columns, {V}),
                         test::to_view<double>(rows, columns, {rate}), dt, threshold);
  };
  EXPECT_DOUBLE_EQ(found(-1.05, 0.03).noise, amplitude);
  EXPECT_GE(found(-1.05, 0.03).node, 0);
  EXPECT_EQ(found(-0.95, 0.03).node, -1) << "decays";
  EXPECT_EQ(found(1.05, 0.03).node, -1) << "grows, but keeps its sign: a front";
  EXPECT_EQ(found(-1.05, 0.26).node, -1) << "below the threshold";
}

TEST(GrowingNoise, NamesItsNode) {
  constexpr int rows = 12, columns = 17, node = columns + 5 * columns + 9;
  const Values zero(rows * columns, 0.0);
  std::vector<Values> V{zero, zero}, rate{zero, zero};
  V[1][node] = 1;
  rate[1][node] = -2.5;
  const auto found = growing_noise(ExecutionSpace(), test::to_view<float>(rows, columns, V),
                                   test::to_view<float>(rows, columns, rate), 1, 0.1);
  EXPECT_NEAR(found.noise, 0.25, 1e-6);
  EXPECT_EQ(found.node, rows * columns + node);
}

TEST(InspectedState, FindsTheSmallestRWhereverItIs) {
  for (const auto& [rows, columns] : {std::pair{2, 2}, {2, 3}, {13, 37}})
    for (const int node : {0, rows * columns / 2, rows * columns - 1}) {
      std::vector<Values> r{test::random_field(rows * columns, 1, 2, 1),
                            test::random_field(rows * columns, 1, 2, 2)};
      const auto V = r;
      r[1][node] = 0.25;
      const auto smallest = [&]<class Real>(Real) {
        return inspect_state(ExecutionSpace(), test::to_view<Real>(rows, columns, V),
                             test::to_view<Real>(rows, columns, r), {})
            .min_r;
      };
      EXPECT_EQ(smallest(double{}), 0.25);
      EXPECT_EQ(smallest(float{}), 0.25);
    }
}

constexpr int rows = 13, columns = 37;

struct Bad {
  int variable;  // V, r, Ta
  int member, i, j;
  double value;
};

template <class Real>
long first_bad(std::initializer_list<Bad> entries, double elsewhere = 0.5) {
  std::vector<Values> fields[3];
  for (auto& field : fields) field.assign(2, Values(rows * columns, elsewhere));
  for (const Bad& b : entries) fields[b.variable][b.member][b.i * columns + b.j] = b.value;
  const auto view = [&](int k) { return test::to_view<Real>(rows, columns, fields[k]); };
  return inspect_state(ExecutionSpace(), view(0), view(1), view(2)).first_non_finite;
}

long index(int member, int i, int j) { return (long(member) * rows + i) * columns + j; }

template <class T>
class FiniteCheck : public ::testing::Test {};
using Precisions = ::testing::Types<double, float>;
TYPED_TEST_SUITE(FiniteCheck, Precisions);

TYPED_TEST(FiniteCheck, AllFinite) {
  EXPECT_EQ(first_bad<TypeParam>({}), -1);
  EXPECT_EQ(first_bad<TypeParam>({}, std::numeric_limits<TypeParam>::denorm_min()), -1);
}

TYPED_TEST(FiniteCheck, HugeValuesAreFinite) {
  // although the sum of three is not
  EXPECT_EQ(first_bad<TypeParam>({}, std::numeric_limits<TypeParam>::max()), -1);
  EXPECT_EQ(first_bad<TypeParam>({}, std::numeric_limits<TypeParam>::lowest()), -1);
}

TYPED_TEST(FiniteCheck, EveryVariableAndKind) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {inf, -inf, nan})
    for (int variable = 0; variable < 3; ++variable)
      for (const auto& [i, j] : {std::pair{0, 0}, {rows - 1, columns - 1}, {7, 0}, {0, columns - 1}, {5, 17}})
        for (int member = 0; member < 2; ++member)
          EXPECT_EQ(first_bad<TypeParam>({{variable, member, i, j, value}}), index(member, i, j));
}

TYPED_TEST(FiniteCheck, InfinitiesThatCancelAreSeen) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(first_bad<TypeParam>({{0, 0, 3, 4, inf}, {1, 0, 3, 4, -inf}}), index(0, 3, 4));
}

TYPED_TEST(FiniteCheck, TheFirstInRowMajorOrder) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(
      first_bad<TypeParam>({{0, 0, 9, 2, nan}, {2, 0, 9, 1, nan}, {1, 0, 4, 30, nan}, {0, 1, 0, 0, nan}}),
      index(0, 4, 30));
  EXPECT_EQ(first_bad<TypeParam>({{0, 0, 9, 2, nan}, {2, 0, 9, 1, nan}}), index(0, 9, 1));
}

}  // namespace
}  // namespace myowave::observe
