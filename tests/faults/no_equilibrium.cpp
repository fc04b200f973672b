// Inputs without a mechanical equilibrium are reported: what, when, what was tried, what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <limits>
#include <string>

#include "kernels/elastic/element.hpp"
#include "solver/base/error.hpp"
#include "solver/mechanics/equibiaxial.hpp"
#include "solver/mechanics/equilibrium.hpp"
#include "solver/mechanics/rest_state.hpp"
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

TEST(NoEquilibrium, FollowerLoadOnASheetWithoutC2IsRefusedWithoutIterating) {
  MechanicsSettings settings;
  settings.c2 = 0;
  for (const double p : {4.0, 10.0, 1e6}) {
    settings.p = p;
    for (const double largest : {0.0, 40.0}) {
      EXPECT_THAT(failure(settings, test::many_fronts<Memory>(sheet, largest, 1)),
                  AllOf(HasSubstr("t = 12.8 t.u."), HasSubstr("nothing was iterated"), HasSubstr("c2 = 0"),
                        HasSubstr("no equilibrium"), HasSubstr("p < 2 c1 = 4")));
    }
  }
}

TEST(NoEquilibrium, BelowThatLoadThereIsOne) {
  MechanicsSettings settings;
  settings.c2 = 0;
  for (const double p : {3.0, 3.999, -10.0}) {
    settings.p = p;
    EXPECT_EQ(failure(settings, GaussTension<Memory>("Ta", sheet.elements())), "no failure") << "p = " << p;
  }
  settings.p = 10;
  settings.load = Load::dead;
  EXPECT_EQ(failure(settings, GaussTension<Memory>("Ta", sheet.elements())), "no failure");
  settings.load = Load::follower;
  settings.edges = Edges::fixed;
  EXPECT_EQ(failure(settings, GaussTension<Memory>("Ta", sheet.elements())), "no failure");
}

// At a bifurcation of the equibiaxial state w_aa = w_ab; a load that pushes would turn the sheet around.
TEST(NoEquilibrium, DeadLoadsWithAnUnstableRestStateAreRefusedWithoutIterating) {
  MechanicsSettings settings;
  settings.load = Load::dead;
  settings.p = largest_dead_load(settings);
  EXPECT_NEAR(settings.p, 22.019, 5e-4);
  const double a = *equibiaxial_stretch(settings, 0);
  const auto w = [](double along, double across) {
    const Mat2 F{along, 0, 0, across};
    return elastic::membrane_energy({}, 0, F).w;
  };
  const double e = 1e-4;
  const double opposite = (w(a + e, a - e) + w(a - e, a + e) - 2 * w(a, a)) / (e * e);
  EXPECT_NEAR(opposite, 0, 1e-3) << "kPa: one side longer, the other shorter";
  const GaussTension<Memory> Ta("Ta", sheet.elements());
  EXPECT_EQ(failure(settings, Ta), "no failure");
  for (const double p : {-1e-3, -30.0, 22.1, 45.0}) {
    settings.p = p;
    EXPECT_THAT(failure(settings, Ta), AllOf(HasSubstr("nothing was iterated"), HasSubstr("0 to 22.02")));
  }
  settings.c2 = 0;
  EXPECT_EQ(failure(settings, Ta), "no failure") << "neo-Hookean sheets do not bifurcate";
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

TEST(NoEquilibrium, WhatWasTriedAndTheRangeOfTheTensionAreNamed) {
  MechanicsSettings settings;
  settings.tolerance = 1e-18;
  const auto Ta = test::tension_from<Memory>(sheet, [](double x, double) { return x < 5 ? 2.5 : 37.5; });
  EXPECT_THAT(
      failure(settings, Ta),
      AllOf(HasSubstr("no equilibrium found"), HasSubstr("2.5 to 37.5 kPa"), HasSubstr("p = 10 kN/m"),
            HasSubstr("c2 = 6"), HasSubstr("Newton iterations"), HasSubstr("ramp"), HasSubstr("min J")));
}

// A tolerance below rounding cannot be reached. The nodes stay those of the last solution.
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
