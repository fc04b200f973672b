// The mechanics far from the paper's values: every outcome of a solve occurs, and failures are reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <cmath>

#include "solver/mechanics/equilibrium.hpp"
#include "solver/studies/mechanics_maps.hpp"
#include "tests/support/sheets.hpp"

namespace myowave::solver {
namespace {

using testing::HasSubstr;
using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;

MechanicsCase spiral(double k_Ta, double p, double c1 = 2, double c2 = 6) {
  MechanicsCase one{.largest_Ta = k_Ta};
  one.settings.c1 = c1;
  one.settings.c2 = c2;
  one.settings.p = p;
  return one;
}

TEST(MechanicsMap, ThePaperConverges) {
  const auto result = solve_case(spiral(20, 10));
  EXPECT_EQ(result.outcome, MechanicsOutcome::converged);
  EXPECT_GT(result.report.min_J, 0.7);
  EXPECT_GT(result.margin, 0.6);
  EXPECT_EQ(result.report.not_elliptic, 0);
}

TEST(MechanicsMap, StrongTensionNeedsShifts) {
  const auto result = solve_case(spiral(47.9, 0));
  EXPECT_EQ(result.outcome, MechanicsOutcome::shifted);
  EXPECT_NEAR(result.report.min_J, 0.39, 0.01);
}

TEST(MechanicsMap, ACheckerboardOfElementsIsRamped) {
  MechanicsCase board = spiral(47.9, 10);
  board.pattern = TensionPattern::checkerboard;
  board.side = 10;
  board.from_rest = true;
  const auto result = solve_case(board);
  EXPECT_EQ(result.outcome, MechanicsOutcome::ramped);
  EXPECT_GT(result.margin, 0);
}

TEST(MechanicsMap, ASpiralOf100KilopascalLosesEllipticity) {
  const auto result = solve_case(spiral(100, 10));
  EXPECT_EQ(result.outcome, MechanicsOutcome::not_elliptic);
  EXPECT_LT(result.margin, 0);
  EXPECT_GT(result.report.not_elliptic, 0) << "reported by a run";
  EXPECT_GT(result.report.min_J, 0) << "J alone does not show it";
}

TEST(MechanicsMap, WithoutARestStateNothingIsIterated) {
  const auto result = solve_case(spiral(20, 10, 2, 0));
  EXPECT_EQ(result.outcome, MechanicsOutcome::no_equilibrium);
  EXPECT_THAT(result.failure, HasSubstr("nothing was iterated"));
}

TEST(MechanicsMap, ASheetFarTooSoftFailsWithAReason) {
  const auto result = solve_case(spiral(47.9, 10, 0, 0.001));
  EXPECT_EQ(result.outcome, MechanicsOutcome::failed);
  EXPECT_THAT(result.failure, HasSubstr("Newton iterations"));
  EXPECT_THAT(result.failure, HasSubstr("exceeds the stiffness"));
}

TEST(MechanicsMap, UniformTensionOf200KilopascalKeepsItsArea) {
  MechanicsCase uniform = spiral(200, 10);
  uniform.pattern = TensionPattern::uniform;
  uniform.side = 4;
  for (const bool from_rest : {false, true}) {
    uniform.from_rest = from_rest;
    const auto result = solve_case(uniform);
    EXPECT_NE(result.outcome, MechanicsOutcome::unnoticed) << result.failure;
    EXPECT_NEAR(result.report.min_J, std::pow(0.4182450954, 2), 1e-8);
    EXPECT_GT(result.margin, 0) << "contraction stiffens";
  }
}

TEST(MechanicsMap, NoPatternOnASmallMeshIsSilentlyWrong) {
  for (int pattern = 0; pattern <= static_cast<int>(TensionPattern::sharp_spiral); ++pattern)
    for (const double k_Ta : {0.0, 47.9, 200.0})
      for (const int side : {1, 2, 5})
        for (const bool from_rest : {false, true}) {
          MechanicsCase one = spiral(k_Ta, 10);
          one.pattern = static_cast<TensionPattern>(pattern);
          one.side = side;
          one.from_rest = from_rest;
          const auto result = solve_case(one);
          EXPECT_LT(result.outcome, MechanicsOutcome::unnoticed)
              << "pattern " << pattern << ", " << k_Ta << " kPa, side " << side << ": " << result.failure;
        }
}

// A tension and its mirror images have equilibria of the same energy.
TEST(MechanicsMap, MirroredTensionsGiveMirroredEquilibria) {
  constexpr int side = 12;
  const elastic::ElementGrid grid{.rows = side, .columns = side, .h = 6};
  const auto oblique = [](double x, double y) { return x + 0.37 * y < 0.685 * side ? 60.0 : 0.0; };
  const Space space;
  const auto solved = [&](const auto& tension) {
    MechanicsSettings settings;
    settings.tolerance = 1e-11;
    Equilibrium<Space> sheet(space, grid, settings);
    return sheet.solve(space, test::tension_from<Memory>(grid, tension), 0);
  };
  const auto plain = solved(oblique);
  const auto left = solved([&](double x, double y) { return oblique(side - x, y); });
  const auto down = solved([&](double x, double y) { return oblique(x, side - y); });
  const auto diagonal = solved([&](double x, double y) { return oblique(y, x); });
  for (const auto& mirrored : {left, down, diagonal}) {
    EXPECT_NEAR(mirrored.energy, plain.energy, 1e-9 * std::abs(plain.energy));
    EXPECT_NEAR(mirrored.min_J, plain.min_J, 1e-7);
  }
}

}  // namespace
}  // namespace myowave::solver
