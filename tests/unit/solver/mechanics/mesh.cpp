#include "solver/mechanics/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/elastic/element.hpp"
#include "solver/base/error.hpp"

namespace myowave::solver {
namespace {

TEST(Mesh, ALoadedSheetIsHeldAtItsMiddleAndItsRightNeighbour) {
  const elastic::ElementGrid grid{.rows = 3, .columns = 5, .h = 6};
  const auto held = held_components(grid, Edges::load);
  EXPECT_EQ(std::count(held.begin(), held.end(), true), 3);
  const int middle = grid.node(1, 2);
  EXPECT_TRUE(held[2 * middle]);
  EXPECT_TRUE(held[2 * middle + 1]);
  EXPECT_TRUE(held[2 * (middle + 1) + 1]);
  EXPECT_EQ(make_mesh(grid, Edges::load).unknowns, 2 * 4 * 6 - 3);
}

TEST(Mesh, FixedEdgesHoldEveryBoundaryNode) {
  const elastic::ElementGrid grid{.rows = 3, .columns = 5, .h = 6};
  const Mesh mesh = make_mesh(grid, Edges::fixed);
  EXPECT_EQ(mesh.unknowns, 2 * 2 * 4);
  EXPECT_EQ(mesh.unknown[2 * grid.node(0, 2)], -1);
  EXPECT_EQ(mesh.unknown[2 * grid.node(3, 5) + 1], -1);
  EXPECT_EQ(mesh.unknown[2 * grid.node(1, 1)], 0);
}

// The paper's sheet: 25 x 25 elements, 1352 components less the three held ones.
TEST(Mesh, RowsAreAscendingAndEndOnTheDiagonal) {
  const Mesh mesh = make_mesh({.rows = 25, .columns = 25, .h = 6}, Edges::load);
  EXPECT_EQ(mesh.unknowns, 1349);
  ASSERT_EQ(mesh.row_begin.size(), 1350u);
  for (int row = 0; row < mesh.unknowns; ++row) {
    const auto first = mesh.column.begin() + mesh.row_begin[row],
               last = mesh.column.begin() + mesh.row_begin[row + 1];
    EXPECT_TRUE(std::is_sorted(first, last));
    EXPECT_EQ(std::adjacent_find(first, last), last);
    EXPECT_EQ(*(last - 1), row);
  }
}

TEST(Mesh, EveryEntryOfAFreeElementIsGatheredOnce) {
  const elastic::ElementGrid grid{.rows = 4, .columns = 3, .h = 6};
  const Mesh mesh = make_mesh(grid, Edges::load);
  std::vector<int> uses(36 * grid.elements());
  for (const int source : mesh.slot_source) ++uses[source];
  for (int e = 0; e < grid.elements(); ++e) {
    for (int a = 0; a < 8; ++a) {
      for (int b = 0; b <= a; ++b) {
        const bool free = mesh.unknown[2 * grid.corner(e, a / 2) + a % 2] >= 0 &&
                          mesh.unknown[2 * grid.corner(e, b / 2) + b % 2] >= 0;
        EXPECT_EQ(uses[36 * e + elastic::tangent_entry(a, b)], free ? 1 : 0);
      }
    }
  }
}

// Of the bilinear element: 2/3 on the diagonal, -1/6 along an edge, -1/3 across.
TEST(Mesh, GradientProductOfOneElement) {
  const Mesh mesh = make_mesh({.rows = 1, .columns = 1, .h = 6}, Edges::load);
  // Held: both components of node 0 and the second of node 1.
  ASSERT_EQ(mesh.unknowns, 5);  // 1x, 2x, 2y, 3x, 3y
  const auto at = [&](int row, int column) { return mesh.gradient_product[mesh.row_begin[row] + column]; };
  EXPECT_NEAR(at(0, 0), 2.0 / 3, 1e-15);
  EXPECT_NEAR(at(1, 0), -1.0 / 3, 1e-15);  // nodes 2 and 1: across
  EXPECT_NEAR(at(2, 0), 0, 1e-15);         // other component
  EXPECT_NEAR(at(3, 0), -1.0 / 6, 1e-15);  // nodes 3 and 1: along an edge
}

TEST(Mesh, EmptyMeshIsAnInputError) {
  EXPECT_THROW(make_mesh({.rows = 0, .columns = 3, .h = 6}, Edges::load), InputError);
  EXPECT_THROW(make_mesh({.rows = 3, .columns = 3, .h = 0}, Edges::load), InputError);
}

TEST(Mesh, FixedEdgesOfOneElementLeaveNoUnknown) {
  EXPECT_EQ(make_mesh({.rows = 1, .columns = 1, .h = 6}, Edges::fixed).unknowns, 0);
}

}  // namespace
}  // namespace myowave::solver
