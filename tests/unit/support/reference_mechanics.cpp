#include "tests/support/reference_mechanics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include "tests/support/allclose.hpp"

namespace myowave::reference {
namespace {

using solver::Load;
using solver::MechanicsSettings;
using testing_support::all_close;

const Mesh mesh{3, 4, 1.5};

MechanicsSettings loaded(Load load, double p) {
  MechanicsSettings m;
  m.load = load;
  m.p = p;
  m.tolerance = 1e-12;
  return m;
}

Values random_values(std::size_t size, double low, double high, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(low, high);
  Values values(size);
  for (double& value : values) value = uniform(engine);
  return values;
}

// Every node off its place by up to 0.15 of an edge.
Values crumpled(unsigned seed) {
  Values x = undeformed(mesh);
  const Values shift = random_values(x.size(), -0.15 * mesh.h, 0.15 * mesh.h, seed);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = 1.1 * x[k] + shift[k];
  return x;
}

struct Equibiaxial {
  double Ta, follower, dead, unloaded, compressed;
};

// Roots of 2 (s - s^-2)(c1 + c2 s) + Ta = p s (follower) or p sqrt(s) (dead), to ten digits.
constexpr Equibiaxial table[] = {
    {0, 1.1293425101, 1.1135877407, 1, 0.9142177266},
    {5, 1.0657419906, 1.0577673201, 0.9481870326, 0.8729358395},
    {10, 1, 1, 0.8980286871, 0.8338255846},
    {20, 0.8756417161, 0.8870965842, 0.8083144454, 0.7642467355},
    {30, 0.7778226566, 0.7918860155, 0.7366052987, 1 / std::numbers::sqrt2},
    {40, 1 / std::numbers::sqrt2, 0.7195898596, 0.6811831838, 0.6610437944},
    {47.9, 0.6649804283, 0.6757039267, 0.6462586579, 0.6309768315},
    {200, 0.4182450954, 0.4198031189, 0.4171480663, 0.4160751844},
};

TEST(ReferenceMechanics, EquibiaxialStretchIsTheKnownOne) {
  for (const auto& row : table) {
    EXPECT_NEAR(equibiaxial_stretch(loaded(Load::follower, 10), row.Ta), row.follower, 1e-10) << row.Ta;
    EXPECT_NEAR(equibiaxial_stretch(loaded(Load::dead, 10), row.Ta), row.dead, 1e-10) << row.Ta;
    EXPECT_NEAR(equibiaxial_stretch(loaded(Load::follower, 0), row.Ta), row.unloaded, 1e-10) << row.Ta;
    EXPECT_NEAR(equibiaxial_stretch(loaded(Load::follower, -10), row.Ta), row.compressed, 1e-10) << row.Ta;
  }
}

TEST(ReferenceMechanics, UniformTensionGivesTheEquibiaxialSheet) {
  for (const Load load : {Load::follower, Load::dead})
    for (const double p : {10.0, 0.0})
      for (const double Ta : {0.0, 10.0, 30.0, 47.9}) {
        const MechanicsSettings m = loaded(load, p);
        const Values x = solve_equilibrium(mesh, m, Values(4 * mesh.elements(), Ta), undeformed(mesh));
        const double lambda = equibiaxial_stretch(m, Ta);
        Values expected = undeformed(mesh);
        const int pin = mesh.node(1, 2);
        const double X1 = expected[2 * pin], X2 = expected[2 * pin + 1];
        for (int n = 0; n < mesh.nodes(); ++n) {
          expected[2 * n] = X1 + lambda * (expected[2 * n] - X1);
          expected[2 * n + 1] = X2 + lambda * (expected[2 * n + 1] - X2);
        }
        EXPECT_TRUE(all_close(x, expected, 2, {.absolute = 1e-11})) << "Ta " << Ta << ", p " << p;
        for (const double area : element_areas(mesh, x))
          EXPECT_NEAR(area, lambda * lambda * mesh.h * mesh.h, 1e-11);
        EXPECT_NEAR(smallest_corner_J(mesh, x), lambda * lambda, 1e-11);
      }
}

TEST(ReferenceMechanics, StressIsTheDerivativeOfTheEnergyAndStiffnessThatOfTheStress) {
  const MechanicsSettings m;
  const double Ta = 17, step = 1e-6;
  const Tensor F{{{1.1, 0.2}, {-0.1, 0.8}}};
  const Tensor S = stress(m, Ta, F);
  const auto D = stiffness(m, Ta, F);
  for (int i = 0; i < 2; ++i)
    for (int P = 0; P < 2; ++P) {
      Tensor more = F, less = F;
      more[i][P] += step;
      less[i][P] -= step;
      // dw/dF_iP = F_iN S_NP
      EXPECT_NEAR((energy_density(m, Ta, more) - energy_density(m, Ta, less)) / (2 * step),
                  F[i][0] * S[0][P] + F[i][1] * S[1][P], 1e-7);
      // dS_MN/dF_iP = D_MNPQ F_iQ
      const Tensor S_more = stress(m, Ta, more), S_less = stress(m, Ta, less);
      for (int M = 0; M < 2; ++M)
        for (int N = 0; N < 2; ++N)
          EXPECT_NEAR((S_more[M][N] - S_less[M][N]) / (2 * step),
                      D[M][N][P][0] * F[i][0] + D[M][N][P][1] * F[i][1], 1e-7);
    }
}

TEST(ReferenceMechanics, ResidualIsTheGradientOfTheEnergy) {
  for (const Load load : {Load::follower, Load::dead}) {
    const MechanicsSettings m = loaded(load, 10);
    const Values Ta = random_values(4 * mesh.elements(), 0, 48, 1), x = crumpled(2);
    const Values R = residual(mesh, m, Ta, x);
    Values difference(x.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      Values more = x, less = x;
      more[k] += 1e-6;
      less[k] -= 1e-6;
      difference[k] = (energy(mesh, m, Ta, more) - energy(mesh, m, Ta, less)) / 2e-6;
    }
    EXPECT_TRUE(all_close(R, difference, 2, {.absolute = 1e-6}));
  }
}

TEST(ReferenceMechanics, TangentIsSymmetricAndTheDerivativeOfTheResidual) {
  for (const Load load : {Load::follower, Load::dead}) {
    const MechanicsSettings m = loaded(load, 10);
    const Values Ta = random_values(4 * mesh.elements(), 0, 48, 3), x = crumpled(4);
    const Values K = tangent(mesh, m, Ta, x);
    const auto size = x.size();
    Values transposed(K.size()), difference(K.size());
    for (std::size_t l = 0; l < size; ++l) {
      Values more = x, less = x;
      more[l] += 1e-6;
      less[l] -= 1e-6;
      const Values R_more = residual(mesh, m, Ta, more), R_less = residual(mesh, m, Ta, less);
      for (std::size_t k = 0; k < size; ++k) {
        transposed[l * size + k] = K[k * size + l];
        difference[k * size + l] = (R_more[k] - R_less[k]) / 2e-6;
      }
    }
    EXPECT_TRUE(all_close(K, transposed, static_cast<int>(size), {.absolute = 1e-12}));
    EXPECT_TRUE(all_close(K, difference, static_cast<int>(size), {.absolute = 1e-6}));
  }
}

TEST(ReferenceMechanics, ReachesEquilibriumFromAfar) {
  for (const Load load : {Load::follower, Load::dead}) {
    const MechanicsSettings m = loaded(load, 10);
    const Values Ta = random_values(4 * mesh.elements(), 0, 48, 5);
    const Values x = solve_equilibrium(mesh, m, Ta, undeformed(mesh));
    EXPECT_GT(smallest_corner_J(mesh, x), 0);
    // With the follower load the pins only fix the position: they carry no force.
    const Values R = residual(mesh, m, Ta, x);
    const auto held = held_coordinates(mesh, m);
    for (std::size_t k = 0; k < R.size(); ++k)
      if (load == Load::follower || !held[k]) {
        EXPECT_NEAR(R[k], 0, 1e-10) << k;
      }
  }
}

TEST(ReferenceMechanics, FixedEdgesKeepTheBoundaryAndTheArea) {
  MechanicsSettings m = loaded(Load::follower, 10);
  m.edges = solver::Edges::fixed;
  const Values Ta = random_values(4 * mesh.elements(), 0, 48, 6);
  const Values X = undeformed(mesh), x = solve_equilibrium(mesh, m, Ta, X);
  double area = 0;
  for (const double a : element_areas(mesh, x)) area += a;
  EXPECT_NEAR(area, mesh.elements() * mesh.h * mesh.h, 1e-12);
  EXPECT_EQ(x[0], X[0]);
  EXPECT_NE(x[2 * mesh.node(1, 1)], X[2 * mesh.node(1, 1)]);
}

TEST(ReferenceMechanics, LinearTensionArrivesAtTheGaussPoints) {
  const Grid grid{10, 13, 0.5};  // three cells an element
  Values Ta(grid.size());
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) Ta[grid.node(i, j)] = 3 + 2 * j * grid.dx - i * grid.dx;
  const Values result = tension_to_gauss(mesh, grid, Ta);
  const double xi[] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  for (int I = 0; I < mesh.rows; ++I)
    for (int J = 0; J < mesh.columns; ++J)
      for (int q = 0; q < 4; ++q)
        EXPECT_NEAR(result[4 * (I * mesh.columns + J) + q],
                    3 + 2 * (J + xi[q % 2]) * mesh.h - (I + xi[q / 2]) * mesh.h, 1e-13);
}

}  // namespace
}  // namespace myowave::reference
