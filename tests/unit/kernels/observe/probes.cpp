#include "kernels/observe/probes.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/support/fields.hpp"

namespace myowave::observe {
namespace {

using test::ExecutionSpace;
using test::MemorySpace;

template <class Real>
void expect_recorded() {
  constexpr int rows = 5, columns = 9;
  test::Values first(rows * columns), second(rows * columns, -1);
  for (int n = 0; n < rows * columns; ++n) first[n] = n;
  const auto field = test::to_view<Real>(rows, columns, {first, second});

  // corners, a node twice, and their order as it is given
  const std::vector<std::int64_t> wanted{44, 0, 8, 23, 23, 36};
  const Kokkos::View<std::int64_t*, MemorySpace> nodes("nodes", wanted.size());
  Kokkos::deep_copy(nodes,
                    Kokkos::View<const std::int64_t*, Kokkos::HostSpace>(wanted.data(), wanted.size()));
  const Kokkos::View<Real**, Kokkos::LayoutRight, MemorySpace> record("record", 3, wanted.size());
  Kokkos::deep_copy(record, Real(7));
  record_probes(ExecutionSpace(), field, nodes, record, 1);
  ExecutionSpace().fence();

  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, record);
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    EXPECT_EQ(host(0, n), Real(7));
    EXPECT_EQ(host(1, n), Real(wanted[n]));
    EXPECT_EQ(host(2, n), Real(7));
  }
}

TEST(Probes, AreValuesOfTheFirstMemberInOneRowOfTheRecord) {
  expect_recorded<double>();
  expect_recorded<float>();
}

TEST(Probes, NoneIsNoError) {
  const auto field = test::to_view<double>(2, 2, {{1, 2, 3, 4}});
  const Kokkos::View<std::int64_t*, MemorySpace> nodes;
  const Kokkos::View<double**, Kokkos::LayoutRight, MemorySpace> record("record", 1, 0);
  record_probes(ExecutionSpace(), field, nodes, record, 0);
}

}  // namespace
}  // namespace myowave::observe
