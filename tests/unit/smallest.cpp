#include "kernels/observe/smallest.hpp"

#include <gtest/gtest.h>

#include "tests/support/fields.hpp"

namespace myowave::observe {
namespace {

TEST(Smallest, IsFoundWhereverItIs) {
  for (const auto& [rows, columns] : {std::pair{1, 1}, {2, 3}, {13, 37}})
    for (const int node : {0, rows * columns / 2, rows * columns - 1}) {
      std::vector<test::Values> members{test::random_field(rows * columns, 1, 2, 1),
                                        test::random_field(rows * columns, 1, 2, 2)};
      members[1][node] = 0.25;
      EXPECT_EQ(smallest(test::ExecutionSpace(), test::to_view<double>(rows, columns, members)), 0.25);
      EXPECT_EQ(smallest(test::ExecutionSpace(), test::to_view<float>(rows, columns, members)), 0.25);
    }
}

}  // namespace
}  // namespace myowave::observe
