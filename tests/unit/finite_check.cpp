#include "kernels/observe/finite_check.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/fields.hpp"

namespace myowave::observe {
namespace {

using test::ExecutionSpace;
using test::Values;

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
  return first_non_finite(ExecutionSpace(), view(0), view(1), view(2));
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
