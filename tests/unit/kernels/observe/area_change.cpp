#include "kernels/observe/area_change.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/allclose.hpp"
#include "tests/support/fields.hpp"

namespace myowave::observe {
namespace {

using test::ExecutionSpace;
using test::MemorySpace;
using test::Values;
using testing_support::all_close;

const reference::Mesh mesh{5, 7, 6};

Values areas_of(const Values& x) {
  const Kokkos::View<double*, MemorySpace> areas("areas", mesh.elements());
  element_areas(ExecutionSpace(), {mesh.rows, mesh.columns, mesh.h}, test::to_nodes(x), areas);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, areas);
  return {host.data(), host.data() + host.size()};
}

TEST(AreaChange, OfAnAffineMapIsItsDeterminant) {
  const Values x = test::mapped(mesh, [](double X1, double X2) {
    return std::array{1.2 * X1 + 0.3 * X2 + 5, -0.1 * X1 + 0.8 * X2};
  });
  EXPECT_TRUE(all_close(areas_of(x), Values(mesh.elements(), 36 * 0.99), mesh.columns, {.relative = 1e-13}));
}

TEST(AreaChange, OfCrumpledElementsIsTheReferences) {
  const Values x = test::crumpled(mesh, 3);
  EXPECT_TRUE(all_close(areas_of(x), reference::element_areas(mesh, x), mesh.columns, {.relative = 1e-13}));
}

TEST(AreaChange, SumIsTheAreaInsideTheBoundary) {
  // Inner nodes at random leave the sum alone.
  const Values X = reference::undeformed(mesh);
  Values x = X;
  const Values displacement = test::random_field(static_cast<int>(x.size()), -1, 1, 4);
  for (int I = 1; I < mesh.rows; ++I)
    for (int J = 1; J < mesh.columns; ++J)
      for (int k = 0; k < 2; ++k) x[2 * mesh.node(I, J) + k] += displacement[2 * mesh.node(I, J) + k];
  const Values areas = areas_of(x);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 35 * 36, 1e-10);
  EXPECT_GT(std::abs(areas[10] - 36), 0.1);
}

TEST(AreaChange, OfAnInvertedElementIsNegative) {
  const Values x = test::mapped(mesh, [](double X1, double X2) { return std::array{-X1, X2}; });
  EXPECT_TRUE(all_close(areas_of(x), Values(mesh.elements(), -36), mesh.columns, {.relative = 1e-13}));
}

}  // namespace
}  // namespace myowave::observe
