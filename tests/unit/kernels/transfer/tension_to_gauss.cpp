#include "kernels/transfer/tension_to_gauss.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/allclose.hpp"
#include "tests/support/fields.hpp"

namespace myowave::transfer {
namespace {

using test::ExecutionSpace;
using test::MemorySpace;
using test::Sheet;
using test::Values;
using testing_support::all_close;

// Column 4 e + q of the result, of one member.
template <class Real>
Values gauss_of(const Sheet& sheet, const std::vector<Values>& Ta, int member) {
  const GaussTension<MemorySpace> gauss("gauss", sheet.elements().elements());
  const EnsembleField<const Real, MemorySpace> view = test::to_view<Real>(sheet.rows, sheet.columns, Ta);
  tension_to_gauss<ExecutionSpace, Real>(ExecutionSpace(), sheet.elements(), sheet.cells, view, member,
                                         gauss);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, gauss);
  return {host.data(), host.data() + host.size()};
}

TEST(TensionToGauss, PointsAreThoseOfTheTwoPointRule) {
  EXPECT_NEAR(elastic::gauss_coordinate(0), 0.5 - 0.5 / std::sqrt(3.0), 1e-16);
  EXPECT_NEAR(elastic::gauss_coordinate(1), 0.5 + 0.5 / std::sqrt(3.0), 1e-16);
}

TEST(TensionToGauss, IsExactForBilinearFields) {
  for (const Sheet& sheet : {Sheet{2, 2, 1}, Sheet{13, 19, 6}, Sheet{21, 31, 10}, Sheet{5, 7, 2}}) {
    const auto field = [](double X1, double X2) { return 3 + 2 * X1 - 0.5 * X2 + 0.25 * X1 * X2; };
    Values Ta, expected;
    for (int i = 0; i < sheet.rows; ++i)
      for (int j = 0; j < sheet.columns; ++j) Ta.push_back(field(j * sheet.dx, i * sheet.dx));
    const auto elements = sheet.elements();
    for (int I = 0; I < elements.rows; ++I)
      for (int J = 0; J < elements.columns; ++J)
        for (int q = 0; q < 4; ++q)
          expected.push_back(field((J + elastic::gauss_coordinate(q % 2)) * elements.h,
                                   (I + elastic::gauss_coordinate(q / 2)) * elements.h));
    EXPECT_TRUE(all_close(gauss_of<double>(sheet, {Ta}, 0), expected, 4, {.relative = 1e-14}));
    EXPECT_TRUE(all_close(gauss_of<float>(sheet, {Ta}, 0), expected, 4, {.relative = 1e-6}));
  }
}

TEST(TensionToGauss, IsTheReferences) {
  for (const Sheet& sheet : {Sheet{2, 2, 1}, Sheet{5, 33, 4}, Sheet{37, 41, 4}, Sheet{31, 21, 10}}) {
    const std::vector<Values> Ta{test::random_field(sheet.size(), 0, 50, 1),
                                 test::random_field(sheet.size(), 0, 50, 2)};
    for (int member = 0; member < 2; ++member)
      EXPECT_TRUE(all_close(gauss_of<double>(sheet, Ta, member),
                            reference::tension_to_gauss(sheet.mesh(), sheet.reference_grid(), Ta[member]), 4,
                            {.absolute = 1e-12}));
  }
}

}  // namespace
}  // namespace myowave::transfer
