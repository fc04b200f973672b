// Inputs without a mechanical equilibrium are reported: what, when, what was tried, what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <limits>
#include <string>

#include "solver/equilibrium.hpp"
#include "solver/error.hpp"
#include "tests/support/sheets.hpp"

namespace myowave::solver {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const elastic::ElementGrid sheet{.rows = 10, .columns = 10, .h = 6};

std::string failure(const MechanicsSettings& settings, const GaussTension<Memory>& Ta) {
  const Space space;
  Equilibrium<Space> equilibrium(space, sheet, settings);
  try {
    equilibrium.solve(space, Ta, 12.8);
  } catch (const NumericalFailure& error) {
    return error.what();
  }
  return "no failure";
}

TEST(NoEquilibrium, FollowerLoadOnASheetWithoutC2) {
  MechanicsSettings settings;
  settings.c2 = 0;
  for (const double largest : {0.0, 40.0}) {
    EXPECT_THAT(
        failure(settings, test::many_fronts<Memory>(sheet, largest, 1)),
        AllOf(HasSubstr("t = 12.8 t.u."), HasSubstr("no equilibrium"), HasSubstr("p = 10 kN/m"),
              HasSubstr("c2 = 0"), HasSubstr("Newton iterations"), HasSubstr("shifts"), HasSubstr("ramp"),
              HasSubstr("min J"), HasSubstr("lower mechanics.p"), HasSubstr("p < 2 c1")));
  }
}

TEST(NoEquilibrium, BelowThatLoadThereIsOne) {
  MechanicsSettings settings;
  settings.c2 = 0;
  settings.p = 3;
  EXPECT_EQ(failure(settings, GaussTension<Memory>("Ta", sheet.elements())), "no failure");
}

TEST(NoEquilibrium, HugeLoadEndsInASolutionOrInAMessage) {
  MechanicsSettings settings;
  for (const double p : {1e3, 1e6, 1e12, -1e3, -1e12}) {
    settings.p = p;
    EXPECT_THAT(failure(settings, test::many_fronts<Memory>(sheet, 40, 1)),
                testing::AnyOf(HasSubstr("no failure"), HasSubstr("exceeds the stiffness")))
        << "p = " << p;
  }
}

TEST(NoEquilibrium, TensionThatIsNotANumberIsNamedWithItsElement) {
  const auto Ta = test::many_fronts<Memory>(sheet, 40, 1);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, Ta);
    const GaussTension<Memory> broken("broken", sheet.elements());
    host(37, 2) = bad;
    Kokkos::deep_copy(broken, host);
    EXPECT_THAT(failure({}, broken),
                AllOf(HasSubstr("t = 12.8"), HasSubstr("not finite in element (row 3, column 7)"),
                      HasSubstr("time.dt")));
  }
}

TEST(NoEquilibrium, TheRangeOfTheTensionIsNamed) {
  MechanicsSettings settings;
  settings.c2 = 0;
  const auto Ta = test::tension_from<Memory>(sheet, [](double x, double) { return x < 5 ? 2.5 : 37.5; });
  EXPECT_THAT(failure(settings, Ta), HasSubstr("2.5 to 37.5 kPa"));
}

// What cannot be reached: a tolerance below rounding. The nodes stay where the last solution was.
TEST(NoEquilibrium, NodesKeepTheLastSolution) {
  MechanicsSettings settings;
  const Space space;
  settings.tolerance = 1e-18;
  Equilibrium<Space> equilibrium(space, sheet, settings);
  EXPECT_THROW(equilibrium.solve(space, test::many_fronts<Memory>(sheet, 40, 1), 0), NumericalFailure);
  const auto x = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, equilibrium.nodes());
  for (int n = 0; n < sheet.nodes(); ++n) {
    EXPECT_EQ(x(n, 0), (n % 11) * 6.0);
    EXPECT_EQ(x(n, 1), (n / 11) * 6.0);
  }
}

}  // namespace
}  // namespace myowave::solver
