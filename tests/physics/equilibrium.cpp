// Equilibria of non-uniform sheets: properties for any tension.
#include "solver/mechanics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <cmath>
#include <vector>

#include "kernels/elastic/assemble.hpp"
#include "solver/mechanics/equibiaxial.hpp"
#include "solver/mechanics/mesh.hpp"
#include "solver/mechanics/sparse_system.hpp"
#include "tests/support/sheets.hpp"

namespace myowave::solver {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;
using elastic::ElementGrid;

MechanicsSettings exact() {
  MechanicsSettings settings;
  settings.tolerance = 1e-12;
  return settings;
}

template <class View>
auto on_host(const View& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
}

GaussTension<Memory> scaled(const GaussTension<Memory>& Ta, double factor) {
  const GaussTension<Memory> zero("zero", Ta.extent(0)), out("scaled", Ta.extent(0));
  elastic::mix_tension(Space(), zero, Ta, factor, out);
  return out;
}

// Largest |residual| at held components and at free ones, kPa x length.
struct Forces {
  double held = 0, free = 0;
};

Forces forces(const ElementGrid& grid, const MechanicsSettings& settings, const Nodes<Memory>& nodes,
              const GaussTension<Memory>& Ta) {
  elastic::Membrane membrane{.passive = settings, .load = {}};
  if (settings.edges == Edges::load) {
    (settings.load == Load::follower ? membrane.load.follower : membrane.load.dead) = settings.p;
  }
  const Mesh mesh = make_mesh(grid, settings.edges);
  SparseSystem<Space> system(Space(), mesh);
  system.assemble(Space(), membrane, grid, nodes, Ta);
  Forces out;
  for (int a = 0; a < 2 * grid.nodes(); ++a) {
    double& largest = mesh.unknown[a] >= 0 ? out.free : out.held;
    largest = std::max(largest, std::abs(system.nodal_residual()(a / 2, a % 2)));
  }
  return out;
}

const ElementGrid paper_sheet{.rows = 25, .columns = 25, .h = 6};

TEST(EquilibriumOfFronts, ColdStartAndRampsReachTheSameEnergy) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto Ta = test::many_fronts<Memory>(paper_sheet, 40, seed);
    const Space space;
    Equilibrium<Space> cold(space, paper_sheet, exact());
    const SolveReport direct = cold.solve(space, Ta, 0);
    EXPECT_GT(direct.min_J, 0);
    EXPECT_LT(direct.residual, 1e-12);
    EXPECT_EQ(direct.ramp_steps, 0);
    for (const int parts : seed == 1 ? std::vector{5, 20} : std::vector{5}) {
      Equilibrium<Space> ramped(space, paper_sheet, exact());
      SolveReport report;
      for (int part = 0; part <= parts; ++part) {
        report = ramped.solve(space, scaled(Ta, static_cast<double>(part) / parts), 0);
        EXPECT_GT(report.min_J, 0) << "seed " << seed << ", part " << part << " of " << parts;
      }
      EXPECT_NEAR(report.energy, direct.energy, 1e-9 * std::abs(direct.energy))
          << "seed " << seed << ", " << parts << " parts";
    }
  }
}

TEST(EquilibriumOfFronts, EveryCornerIsUprightWhileTheFrontsTurn) {
  const Space space;
  Equilibrium<Space> equilibrium(space, paper_sheet, MechanicsSettings{});
  for (int solve = 0; solve < 20; ++solve) {
    // 80 steps of 0.02 t.u. in a period of 26.85 t.u.
    const auto Ta = test::many_fronts<Memory>(paper_sheet, 47.9, 4, solve * 1.6 / 26.85);
    const SolveReport report = equilibrium.solve(space, Ta, 1.6 * solve);
    const auto x = on_host(equilibrium.nodes());
    double min_J = 1e300;
    for (int e = 0; e < paper_sheet.elements(); ++e) {
      min_J =
          std::min(min_J, elastic::min_corner_J(elastic::element_nodes(paper_sheet, x, e), paper_sheet.h));
    }
    EXPECT_GT(min_J, 0);
    EXPECT_DOUBLE_EQ(min_J, report.min_J);
    EXPECT_LT(report.residual, 1e-8);
    EXPECT_LE(report.iterations, 60);
  }
}

TEST(EquilibriumOfFronts, HeldComponentsCarryNoForce) {
  const Space space;
  for (const Load load : {Load::follower, Load::dead}) {
    auto settings = exact();
    settings.load = load;
    Equilibrium<Space> equilibrium(space, paper_sheet, settings);
    const auto Ta = test::many_fronts<Memory>(paper_sheet, 40, 5);
    equilibrium.solve(space, Ta, 0);
    const Forces found = forces(paper_sheet, settings, equilibrium.nodes(), Ta);
    EXPECT_LT(found.free, 1e-12 * 10 * paper_sheet.h);
    // The follower load has no resultant and no moment on the deformed sheet. The dead load has no resultant,
    // but it may turn the sheet against the pin.
    if (load == Load::follower) {
      EXPECT_LT(found.held, 1e-9);
    }
  }
}

TEST(EquilibriumOfFronts, FixedEdgesStayAndTheEdgeLoadHasNoEffect) {
  const ElementGrid grid{.rows = 8, .columns = 11, .h = 6};
  const Space space;
  const auto Ta = test::many_fronts<Memory>(grid, 40, 6);
  auto settings = exact();
  settings.edges = Edges::fixed;
  Equilibrium<Space> equilibrium(space, grid, settings);
  settings.p = -30;
  Equilibrium<Space> other(space, grid, settings);
  equilibrium.solve(space, Ta, 0);
  other.solve(space, Ta, 0);
  const auto x = on_host(equilibrium.nodes()), y = on_host(other.nodes());
  double moved = 0;
  for (int I = 0; I <= grid.rows; ++I) {
    for (int J = 0; J <= grid.columns; ++J) {
      const int n = grid.node(I, J);
      EXPECT_EQ(x(n, 0), y(n, 0));
      EXPECT_EQ(x(n, 1), y(n, 1));
      const double away = std::hypot(x(n, 0) - J * grid.h, x(n, 1) - I * grid.h);
      if (I == 0 || I == grid.rows || J == 0 || J == grid.columns) {
        EXPECT_EQ(away, 0);
      } else {
        moved = std::max(moved, away);
      }
    }
  }
  EXPECT_GT(moved, 0.1 * grid.h);
}

// Tension around the middle of an even mesh, where the held node is: the square's symmetries.
TEST(EquilibriumOfADisc, HasTheSymmetryOfTheSquare) {
  const int n = 12;
  const ElementGrid grid{.rows = n, .columns = n, .h = 6};
  const auto Ta = test::tension_from<Memory>(grid, [&](double x, double y) {
    return 35 * std::exp(-(std::pow(x - 0.5 * n, 2) + std::pow(y - 0.5 * n, 2)) / 10);
  });
  const Space space;
  for (const Edges edges : {Edges::load, Edges::fixed}) {
    auto settings = exact();
    settings.edges = edges;
    Equilibrium<Space> equilibrium(space, grid, settings);
    equilibrium.solve(space, Ta, 0);
    const auto x = on_host(equilibrium.nodes());
    const double middle = 0.5 * n * grid.h;
    const auto u = [&](int I, int J, int i) { return x(grid.node(I, J), i) - middle; };
    for (int I = 0; I <= n; ++I) {
      for (int J = 0; J <= n; ++J) {
        EXPECT_NEAR(u(I, J, 0), -u(I, n - J, 0), 1e-8);
        EXPECT_NEAR(u(I, J, 1), u(I, n - J, 1), 1e-8);
        EXPECT_NEAR(u(I, J, 0), u(J, I, 1), 1e-8);  // diagonal
        EXPECT_NEAR(u(I, J, 1), -u(n - I, J, 1), 1e-8);
      }
    }
  }
}

TEST(Equilibrium, WarmStartAtTheSameTensionTakesNoIteration) {
  const Space space;
  Equilibrium<Space> equilibrium(space, paper_sheet, MechanicsSettings{});
  const auto Ta = test::many_fronts<Memory>(paper_sheet, 40, 7);
  EXPECT_GT(equilibrium.solve(space, Ta, 0).iterations, 0);
  EXPECT_EQ(equilibrium.solve(space, Ta, 1).iterations, 0);
  equilibrium.reset(space);
  const auto x = on_host(equilibrium.nodes());
  EXPECT_EQ(x(paper_sheet.node(25, 3), 0), 18);
  EXPECT_EQ(x(paper_sheet.node(25, 3), 1), 150);
  EXPECT_GT(equilibrium.solve(space, Ta, 2).iterations, 0);
}

// Where Pi passes through zero, its relative rounding must not stop the line search.
TEST(Equilibrium, ConvergesWherePiIsZero) {
  const ElementGrid grid{.rows = 6, .columns = 6, .h = 6};
  const auto Ta = test::many_fronts<Memory>(grid, 1, 8);
  const Space space;
  Equilibrium<Space> equilibrium(space, grid, exact());
  double low = 40, high = 100;  // largest tension, Pi > 0 and < 0
  for (int bisection = 0; bisection < 60; ++bisection) {
    const double middle = 0.5 * (low + high);
    const SolveReport report = equilibrium.solve(space, scaled(Ta, middle), 0);
    ASSERT_EQ(report.ramp_steps, 0);
    (report.energy > 0 ? low : high) = middle;
  }
  EXPECT_GT(low, 40);
  EXPECT_LT(high, 100);
  Equilibrium<Space> cold(space, grid, exact());
  const SolveReport report = cold.solve(space, scaled(Ta, low), 0);
  EXPECT_LT(std::abs(report.energy), 1e-6);
  EXPECT_LE(report.iterations, 20);
}

// Sheets from one element to strips.
TEST(Equilibrium, SmallAndNarrowSheets) {
  const Space space;
  for (const ElementGrid grid : {ElementGrid{1, 1, 6}, ElementGrid{1, 2, 6}, ElementGrid{2, 1, 6},
                                 ElementGrid{1, 30, 6}, ElementGrid{30, 1, 6}, ElementGrid{2, 2, 0.1}}) {
    Equilibrium<Space> equilibrium(space, grid, exact());
    const auto Ta = test::many_fronts<Memory>(grid, 40, 9);
    const SolveReport report = equilibrium.solve(space, Ta, 0);
    EXPECT_LT(report.residual, 1e-12) << grid.rows << " x " << grid.columns;
    EXPECT_LT(forces(grid, exact(), equilibrium.nodes(), Ta).held, 1e-9 * grid.h)
        << grid.rows << " x " << grid.columns;
  }
}

TEST(Equilibrium, FixedEdgesOfOneElementLeaveItUndeformed) {
  auto settings = exact();
  settings.edges = Edges::fixed;
  const Space space;
  Equilibrium<Space> equilibrium(space, {.rows = 1, .columns = 1, .h = 6}, settings);
  const GaussTension<Memory> Ta("Ta", 1);
  Kokkos::deep_copy(Ta, 20);
  EXPECT_EQ(equilibrium.solve(space, Ta, 0).iterations, 0);
}

#if defined(KOKKOS_ENABLE_OPENMP) && !defined(KOKKOS_ENABLE_CUDA) && !defined(KOKKOS_ENABLE_HIP)
TEST(Equilibrium, BitsDoNotDependOnTheNumberOfThreads) {
  if (Kokkos::OpenMP().concurrency() < 2) GTEST_SKIP() << "needs OMP_NUM_THREADS >= 2";
  const auto Ta = test::many_fronts<Memory>(paper_sheet, 47.9, 10);
  const auto solved = [&](const Kokkos::OpenMP& space, SolveReport& report) {
    Equilibrium<Kokkos::OpenMP> equilibrium(space, paper_sheet, MechanicsSettings{});
    report = equilibrium.solve(space, Ta, 0);
    return on_host(equilibrium.nodes());
  };
  SolveReport one, all;
  const auto x = solved(Kokkos::OpenMP(1), one), y = solved(Kokkos::OpenMP(), all);
  EXPECT_EQ(one.factorizations, all.factorizations);
  EXPECT_EQ(one.energy, all.energy);
  EXPECT_EQ(one.residual, all.residual);
  for (int n = 0; n < paper_sheet.nodes(); ++n) {
    EXPECT_EQ(x(n, 0), y(n, 0));
    EXPECT_EQ(x(n, 1), y(n, 1));
  }
}
#endif

}  // namespace
}  // namespace myowave::solver
