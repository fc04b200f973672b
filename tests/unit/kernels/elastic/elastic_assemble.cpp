// The launchers against plain loops over the elements, and the assembled derivatives against
// differences of the assembled energy.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/elastic/assemble.hpp"
#include "solver/mechanics/mesh.hpp"
#include "solver/mechanics/sparse_system.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/sheets.hpp"

namespace myowave::solver {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;
using elastic::ElementGrid;
using elastic::Membrane;

const Membrane membrane{.passive = {}, .load = {.follower = 10, .dead = 0}};

template <class View>
auto on_host(const View& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
}

// A sheet with its dense assembled residual and tangent, all degrees of freedom, by plain loops.
struct Sheet {
  ElementGrid grid;
  Nodes<Memory> nodes;
  GaussTension<Memory> Ta;

  explicit Sheet(const ElementGrid& g)
      : grid(g), nodes(test::rough_nodes<Memory>(g, 0.15, 1)), Ta(test::many_fronts<Memory>(g, 40, 2)) {}

  elastic::ElementLinearization linearized(int e, double& energy, double& min_J) const {
    const auto x = on_host(nodes);
    const auto T = on_host(Ta);
    const auto element = elastic::element_nodes(grid, x, e);
    const double tension[4] = {T(e, 0), T(e, 1), T(e, 2), T(e, 3)};
    energy = elastic::element_energy(membrane, element, tension, grid.h);
    min_J = elastic::min_corner_J(element, grid.h);
    return elastic::linearize_element(membrane, element, tension, grid.h);
  }
};

class Assemble : public testing::TestWithParam<ElementGrid> {};

TEST_P(Assemble, EqualsPlainLoopsOverTheElements) {
  const Sheet sheet(GetParam());
  const auto& grid = sheet.grid;
  const int dofs = 2 * grid.nodes();
  std::vector<double> R(dofs), K(static_cast<std::size_t>(dofs) * dofs), energies(grid.elements()),
      min_J(grid.elements());
  for (int e = 0; e < grid.elements(); ++e) {
    const auto element = sheet.linearized(e, energies[e], min_J[e]);
    for (int a = 0; a < 8; ++a) {
      const int ga = 2 * grid.corner(e, a / 2) + a % 2;
      R[ga] += element.R[a];
      for (int b = 0; b < 8; ++b) {
        const int gb = 2 * grid.corner(e, b / 2) + b % 2;
        K[static_cast<std::size_t>(ga) * dofs + gb] +=
            element.K[elastic::tangent_entry(std::max(a, b), std::min(a, b))];
      }
    }
  }

  const Space space;
  elastic::Rows<Memory> energy("energy", 2, grid.elements());
  elastic::element_energies(space, membrane, grid, sheet.nodes, sheet.Ta, energy);
  const auto energy_host = on_host(energy);
  for (int e = 0; e < grid.elements(); ++e) {
    EXPECT_NEAR(energy_host(0, e), energies[e], 1e-13 * std::abs(energies[e]));
    EXPECT_NEAR(energy_host(1, e), min_J[e], 1e-15);
  }

  const Mesh mesh = make_mesh(grid, Edges::load);
  SparseSystem<Space> system(space, mesh);
  system.assemble(space, membrane, grid, sheet.nodes, sheet.Ta);
  for (int a = 0; a < dofs; ++a) {
    EXPECT_NEAR(system.nodal_residual()(a / 2, a % 2), R[a], 1e-13 * 100 * grid.h);
    if (mesh.unknown[a] >= 0) {
      EXPECT_EQ(system.residual()[mesh.unknown[a]], system.nodal_residual()(a / 2, a % 2));
    }
  }
  std::vector<double> lower(static_cast<std::size_t>(mesh.unknowns) * mesh.unknowns);
  for (int row = 0; row < mesh.unknowns; ++row) {
    for (int slot = mesh.row_begin[row]; slot < mesh.row_begin[row + 1]; ++slot) {
      lower[static_cast<std::size_t>(row) * mesh.unknowns + mesh.column[slot]] = system.tangent(0)[slot];
    }
  }
  for (int a = 0; a < dofs; ++a) {
    for (int b = 0; b < dofs; ++b) {
      const int row = mesh.unknown[a], column = mesh.unknown[b];
      if (row < 0 || column < 0 || column > row) continue;
      EXPECT_NEAR(lower[static_cast<std::size_t>(row) * mesh.unknowns + column],
                  K[static_cast<std::size_t>(a) * dofs + b], 1e-12 * 100);
      EXPECT_NEAR(K[static_cast<std::size_t>(a) * dofs + b], K[static_cast<std::size_t>(b) * dofs + a],
                  1e-12 * 100);
    }
  }
}

TEST_P(Assemble, ResidualAndTangentAreDerivativesOfTheAssembledEnergy) {
  const Sheet sheet(GetParam());
  const auto& grid = sheet.grid;
  const Space space;
  const Mesh mesh = make_mesh(grid, Edges::load);
  SparseSystem<Space> system(space, mesh);
  elastic::Rows<Memory> energy("energy", 2, grid.elements());

  // A random direction of the unknowns.
  test::Uniform uniform(5);
  std::vector<double> d(mesh.unknowns);
  for (double& v : d) v = uniform(-1, 1);
  Nodes<Memory> direction("direction", grid.nodes()), moved("moved", grid.nodes());
  const auto direction_host = Kokkos::create_mirror_view(direction);
  system.scatter(d, direction_host);
  Kokkos::deep_copy(direction, direction_host);
  const auto move = [&](double s) { elastic::move_nodes(space, sheet.nodes, direction, s, moved); };

  system.assemble(space, membrane, grid, sheet.nodes, sheet.Ta);
  const std::vector<double> R(system.residual().begin(), system.residual().end());
  const std::vector<double> K(system.tangent(0).begin(), system.tangent(0).end());
  double slope = 0, size = 0;
  for (int a = 0; a < mesh.unknowns; ++a) {
    slope += R[a] * d[a];
    size += std::abs(R[a] * d[a]);
  }
  const double found = test::derivative([&](double s) {
    move(s);
    elastic::element_energies(space, membrane, grid, moved, sheet.Ta, energy);
    const auto host = on_host(energy);
    double sum = 0;
    for (int e = 0; e < grid.elements(); ++e) sum += host(0, e);
    return sum;
  });
  EXPECT_NEAR(found, slope, 1e-7 * size);

  std::vector<double> Kd(mesh.unknowns);
  for (int row = 0; row < mesh.unknowns; ++row) {
    for (int slot = mesh.row_begin[row]; slot < mesh.row_begin[row + 1]; ++slot) {
      const int column = mesh.column[slot];
      Kd[row] += K[slot] * d[column];
      if (column != row) Kd[column] += K[slot] * d[row];
    }
  }
  for (int a = 0; a < mesh.unknowns; ++a) {
    const double difference = test::derivative([&](double s) {
      move(s);
      system.assemble(space, membrane, grid, moved, sheet.Ta);
      return system.residual()[a];
    });
    EXPECT_NEAR(difference, Kd[a], 1e-7 * 100) << "unknown " << a;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Assemble,
                         testing::Values(ElementGrid{1, 1, 6}, ElementGrid{2, 3, 6}, ElementGrid{5, 4, 0.7},
                                         ElementGrid{1, 7, 6}, ElementGrid{2, 8, 6}, ElementGrid{3, 11, 6}));

// An affine deformation under uniform tension: the stress is uniform, so inner nodes have no force, and nodes
// on the edge have the traction P N.
TEST(PatchTest, AffineDeformationLeavesNoForceInside) {
  const ElementGrid grid{.rows = 4, .columns = 5, .h = 6};
  const Mat2 F{1.2, 0.3, -0.1, 0.8};
  Nodes<Memory> nodes("nodes", grid.nodes());
  const auto host = Kokkos::create_mirror_view(nodes);
  for (int n = 0; n < grid.nodes(); ++n) {
    const double X1 = (n % (grid.columns + 1)) * grid.h, X2 = (n / (grid.columns + 1)) * grid.h;
    host(n, 0) = 3 + F.m11 * X1 + F.m12 * X2;
    host(n, 1) = 1 + F.m21 * X1 + F.m22 * X2;
  }
  Kokkos::deep_copy(nodes, host);
  const auto Ta = test::tension_from<Memory>(grid, [](double, double) { return 30.0; });
  const Space space;
  SparseSystem<Space> system(space, make_mesh(grid, Edges::load));
  system.assemble(space, membrane, grid, nodes, Ta);
  const Mat2 P = elastic::first_piola_kirchhoff(elastic::membrane_energy(membrane, 30, F), F);
  for (int I = 0; I <= grid.rows; ++I) {
    for (int J = 0; J <= grid.columns; ++J) {
      // Lengths of edge around the node with normals along X1 and X2.
      const double along_2 = I == 0 || I == grid.rows ? 0.5 * grid.h : grid.h;
      const double along_1 = J == 0 || J == grid.columns ? 0.5 * grid.h : grid.h;
      const double n1 = J == 0 ? -along_2 : J == grid.columns ? along_2 : 0;
      const double n2 = I == 0 ? -along_1 : I == grid.rows ? along_1 : 0;
      const int n = grid.node(I, J);
      EXPECT_NEAR(system.nodal_residual()(n, 0), P.m11 * n1 + P.m12 * n2, 1e-11) << I << ", " << J;
      EXPECT_NEAR(system.nodal_residual()(n, 1), P.m21 * n1 + P.m22 * n2, 1e-11) << I << ", " << J;
    }
  }
}

// The forces of the follower load on the deformed boundary of the sheet, edge by edge, against the
// contribution of the bulk term to the assembled residual.
TEST(EdgeLoad, BulkTermOfTheSheetIsTheForceOnItsDeformedBoundary) {
  const ElementGrid grid{.rows = 3, .columns = 4, .h = 6};
  const Sheet sheet(grid);
  const Space space;
  const Mesh mesh = make_mesh(grid, Edges::load);
  SparseSystem<Space> loaded(space, mesh), free(space, mesh);
  loaded.assemble(space, membrane, grid, sheet.nodes, sheet.Ta);
  free.assemble(space, Membrane{.passive = membrane.passive, .load = {}}, grid, sheet.nodes, sheet.Ta);
  std::vector<int> around;  // counter-clockwise
  for (int J = 0; J < grid.columns; ++J) around.push_back(grid.node(0, J));
  for (int I = 0; I < grid.rows; ++I) around.push_back(grid.node(I, grid.columns));
  for (int J = grid.columns; J > 0; --J) around.push_back(grid.node(grid.rows, J));
  for (int I = grid.rows; I >= 0; --I) around.push_back(grid.node(I, 0));
  const auto x = on_host(sheet.nodes);
  std::vector<double> force(2 * grid.nodes());
  for (std::size_t k = 0; k + 1 < around.size(); ++k) {
    const int a = around[k], b = around[k + 1];
    const auto f = elastic::edge_force(10, x(a, 0), x(a, 1), x(b, 0), x(b, 1));
    for (const int end : {a, b}) {
      force[2 * end] += f.f1;
      force[2 * end + 1] += f.f2;
    }
  }
  for (int a = 0; a < 2 * grid.nodes(); ++a) {
    EXPECT_NEAR(free.nodal_residual()(a / 2, a % 2) - loaded.nodal_residual()(a / 2, a % 2), force[a], 1e-11);
  }
}

TEST(Assemble, FindsAnInvertedCorner) {
  const ElementGrid grid{.rows = 1, .columns = 1, .h = 1};
  Nodes<Memory> nodes("nodes", 4);
  const auto host = Kokkos::create_mirror_view(nodes);
  const double x[4][2] = {{0, 0}, {1, 0}, {0, 1}, {0.45, 0.45}};
  for (int n = 0; n < 4; ++n) {
    for (int i = 0; i < 2; ++i) host(n, i) = x[n][i];
  }
  Kokkos::deep_copy(nodes, host);
  const elastic::Rows<Memory> energy("energy", 2, 1);
  const GaussTension<Memory> Ta("Ta", 1);
  elastic::element_energies(Space(), membrane, grid, nodes, Ta, energy);
  EXPECT_NEAR(on_host(energy)(1, 0), -0.1, 1e-15);
}

TEST(Assemble, TurningTwiceIsNoTurn) {
  const ElementGrid grid{.rows = 2, .columns = 2, .h = 6};
  const auto nodes = test::rough_nodes<Memory>(grid, 0.1, 3);
  const auto before = on_host(nodes);
  const Nodes<Memory> turned("turned", grid.nodes());
  Kokkos::deep_copy(turned, nodes);
  elastic::turn_around(Space(), 4, turned);
  const auto x = on_host(turned);
  for (int n = 0; n < grid.nodes(); ++n) {
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(x(n, i) - before(4, i), before(4, i) - before(n, i), 1e-14);
  }
}

TEST(Assemble, MixedTensionAndUniformSheet) {
  const ElementGrid grid{.rows = 2, .columns = 3, .h = 6};
  const auto from = test::many_fronts<Memory>(grid, 40, 1), to = test::many_fronts<Memory>(grid, 20, 2);
  const GaussTension<Memory> mixed("mixed", grid.elements());
  elastic::mix_tension(Space(), from, to, 0.25, mixed);
  const auto a = on_host(from), b = on_host(to), m = on_host(mixed);
  for (int e = 0; e < grid.elements(); ++e) {
    for (int q = 0; q < 4; ++q) EXPECT_NEAR(m(e, q), 0.75 * a(e, q) + 0.25 * b(e, q), 1e-13);
  }
  const Nodes<Memory> nodes("nodes", grid.nodes());
  elastic::place_uniform(Space(), grid, 1.5, nodes);
  const auto x = on_host(nodes);
  EXPECT_DOUBLE_EQ(x(grid.node(1, 1), 0), 6);  // the middle does not move
  EXPECT_DOUBLE_EQ(x(grid.node(1, 1), 1), 6);
  EXPECT_DOUBLE_EQ(x(grid.node(2, 3), 0), 6 + 1.5 * 12);
  EXPECT_DOUBLE_EQ(x(grid.node(2, 3), 1), 6 + 1.5 * 6);
}

}  // namespace
}  // namespace myowave::solver
