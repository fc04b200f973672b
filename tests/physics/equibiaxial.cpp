// The uniform solution of the loaded, uniformly active membrane against the scalar equation
//   2 (s - s^-2)(c1 + c2 s) + Ta = p s (follower) or p sqrt(s) (dead),   s = lambda^2.
#include "solver/mechanics/equibiaxial.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <cmath>
#include <numbers>

#include "solver/mechanics/equilibrium.hpp"

namespace myowave::solver {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;

struct Case {
  const char* name;
  Load load;
  double p;   // kN/m
  double Ta;  // kPa
  double stretch;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name << " Ta " << c.Ta; }

class Equibiaxial : public testing::TestWithParam<Case> {};

TEST_P(Equibiaxial, StretchIsTheRootOfTheScalarEquation) {
  const Case c = GetParam();
  const elastic::ElementGrid grid{.rows = 5, .columns = 7, .h = 6};
  MechanicsSettings settings;
  settings.load = c.load;
  settings.p = c.p;
  settings.tolerance = 1e-12;
  const Space space;
  Equilibrium<Space> equilibrium(space, grid, settings);
  const GaussTension<Memory> Ta("Ta", grid.elements());
  // From another tension, because a first solve starts at the root itself.
  Kokkos::deep_copy(Ta, c.Ta == 30 ? 20 : 30);
  equilibrium.solve(space, Ta, 0);
  Kokkos::deep_copy(Ta, c.Ta);
  const SolveReport report = equilibrium.solve(space, Ta, 1.6);
  EXPECT_GT(report.iterations, 0);
  EXPECT_LT(report.residual, 1e-12);
  EXPECT_NEAR(report.min_J, c.stretch * c.stretch, 1e-9);

  const auto x = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, equilibrium.nodes());
  const int held = grid.node(grid.rows / 2, grid.columns / 2);
  for (int I = 0; I <= grid.rows; ++I) {
    for (int J = 0; J <= grid.columns; ++J) {
      const int n = grid.node(I, J);
      const double X1 = (J - grid.columns / 2) * grid.h, X2 = (I - grid.rows / 2) * grid.h;
      EXPECT_NEAR(x(n, 0) - x(held, 0), c.stretch * X1, 1e-9 * 7 * grid.h) << "node " << I << ", " << J;
      EXPECT_NEAR(x(n, 1) - x(held, 1), c.stretch * X2, 1e-9 * 7 * grid.h) << "node " << I << ", " << J;
    }
  }
}

TEST_P(Equibiaxial, ScalarSolutionIsTheSameRoot) {
  const Case c = GetParam();
  MechanicsSettings settings;
  settings.load = c.load;
  settings.p = c.p;
  EXPECT_NEAR(equibiaxial_stretch(settings, c.Ta).value(), c.stretch, 1e-10);
}

TEST(EquibiaxialRoot, IsAbsentWhereAFollowerLoadOutgrowsTheSheet) {
  MechanicsSettings settings;
  settings.c2 = 0;
  settings.p = 4;  // = 2 c1
  EXPECT_FALSE(equibiaxial_stretch(settings, 0).has_value());
  settings.p = 3.9;
  EXPECT_TRUE(equibiaxial_stretch(settings, 0).has_value());
  settings.p = 10;
  settings.load = Load::dead;
  EXPECT_TRUE(equibiaxial_stretch(settings, 0).has_value());
}

TEST(EquibiaxialRoot, LoadedRestArea) {
  EXPECT_NEAR(std::pow(equibiaxial_stretch(MechanicsSettings{}, 0).value(), 2), 1.2754145052, 1e-10);
}

constexpr double half = 1 / std::numbers::sqrt2;
constexpr auto follower = Load::follower;

INSTANTIATE_TEST_SUITE_P(
    Follower, Equibiaxial,
    testing::Values(Case{"p 10", follower, 10, 0, 1.1293425101}, Case{"p 10", follower, 10, 5, 1.0657419906},
                    Case{"p 10", follower, 10, 10, 1}, Case{"p 10", follower, 10, 20, 0.8756417161},
                    Case{"p 10", follower, 10, 30, 0.7778226566}, Case{"p 10", follower, 10, 40, half},
                    Case{"p 10", follower, 10, 47.9, 0.6649804283},
                    Case{"p 10", follower, 10, 200, 0.4182450954}));
INSTANTIATE_TEST_SUITE_P(Dead, Equibiaxial,
                         testing::Values(Case{"p 10", Load::dead, 10, 0, 1.1135877407},
                                         Case{"p 10", Load::dead, 10, 5, 1.0577673201},
                                         Case{"p 10", Load::dead, 10, 10, 1},
                                         Case{"p 10", Load::dead, 10, 20, 0.8870965842},
                                         Case{"p 10", Load::dead, 10, 30, 0.7918860155},
                                         Case{"p 10", Load::dead, 10, 40, 0.7195898596},
                                         Case{"p 10", Load::dead, 10, 47.9, 0.6757039267},
                                         Case{"p 10", Load::dead, 10, 200, 0.4198031189}));
INSTANTIATE_TEST_SUITE_P(
    Unloaded, Equibiaxial,
    testing::Values(Case{"p 0", follower, 0, 0, 1}, Case{"p 0", follower, 0, 5, 0.9481870326},
                    Case{"p 0", follower, 0, 10, 0.8980286871}, Case{"p 0", follower, 0, 20, 0.8083144454},
                    Case{"p 0", follower, 0, 30, 0.7366052987}, Case{"p 0", follower, 0, 40, 0.6811831838},
                    Case{"p 0", follower, 0, 47.9, 0.6462586579},
                    Case{"p 0", follower, 0, 200, 0.4171480663}));
INSTANTIATE_TEST_SUITE_P(Compressed, Equibiaxial,
                         testing::Values(Case{"p -10", follower, -10, 0, 0.9142177266},
                                         Case{"p -10", follower, -10, 5, 0.8729358395},
                                         Case{"p -10", follower, -10, 10, 0.8338255846},
                                         Case{"p -10", follower, -10, 20, 0.7642467355},
                                         Case{"p -10", follower, -10, 30, half},
                                         Case{"p -10", follower, -10, 40, 0.6610437944},
                                         Case{"p -10", follower, -10, 47.9, 0.6309768315},
                                         Case{"p -10", follower, -10, 200, 0.4160751844}));

}  // namespace
}  // namespace myowave::solver
