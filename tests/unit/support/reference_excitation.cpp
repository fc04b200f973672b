#include "tests/support/reference_excitation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numeric>
#include <random>

#include "tests/support/allclose.hpp"

namespace myowave::reference {
namespace {

using testing_support::all_close;

const Grid grid{13, 17, 0.6};
const Mesh mesh{3, 4, 2.4};  // four cells an element

using Function = std::function<double(double, double)>;
using Map = std::function<std::array<double, 2>(double, double)>;

Values sampled(const Grid& g, const Function& f) {
  Values values(g.size());
  for (int i = 0; i < g.rows; ++i)
    for (int j = 0; j < g.columns; ++j) values[g.node(i, j)] = f(j * g.dx, i * g.dx);
  return values;
}

Values mapped(const Mesh& m, const Map& map) {
  Values x = undeformed(m);
  for (int n = 0; n < m.nodes(); ++n) {
    const auto [x1, x2] = map(x[2 * n], x[2 * n + 1]);
    x[2 * n] = x1;
    x[2 * n + 1] = x2;
  }
  return x;
}

Values crumpled() {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(-0.15 * mesh.h, 0.15 * mesh.h);
  return mapped(mesh, [&](double X1, double X2) {
    return std::array{1.1 * X1 + uniform(engine), 0.9 * X2 + uniform(engine)};
  });
}

Values random_field(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  return sampled(grid, [&](double, double) { return uniform(engine); });
}

double total(const Values& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(ReferenceExcitation, UndeformedMetricsAreTheFivePointStencil) {
  const Values V = random_field(1), X = undeformed(mesh), expected = diffusion_identity(grid, V);
  EXPECT_TRUE(
      all_close(diffusion_conservative(grid, mesh, X, V), expected, grid.columns, {.absolute = 1e-13}));
  EXPECT_TRUE(all_close(diffusion_expanded(grid, mesh, X, V), expected, grid.columns, {.absolute = 1e-13}));
}

TEST(ReferenceExcitation, FivePointStencilMirrorsAboutTheEdges) {
  const Grid square{3, 3, 0.5};
  Values V(9);
  V[square.node(0, 1)] = 1;
  const Values expected{8, -16, 8, 0, 4, 0, 0, 0, 0};
  EXPECT_TRUE(all_close(diffusion_identity(square, V), expected, 3, {}));
}

TEST(ReferenceExcitation, ConservativeFormConservesDissipatesAndIsSymmetric) {
  const Values x = crumpled(), U = random_field(2), V = random_field(3);
  ASSERT_GT(smallest_corner_J(mesh, x), 0);
  const Values M = node_weights(grid, mesh, x);
  const Values LU = diffusion_conservative(grid, mesh, x, U), LV = diffusion_conservative(grid, mesh, x, V);
  double sum = 0, U_LV = 0, V_LU = 0, V_LV = 0;
  for (int n = 0; n < grid.size(); ++n) {
    sum += M[n] * LV[n];
    U_LV += M[n] * U[n] * LV[n];
    V_LU += M[n] * V[n] * LU[n];
    V_LV += M[n] * V[n] * LV[n];
  }
  EXPECT_NEAR(sum, 0, 1e-11);
  EXPECT_NEAR(U_LV, V_LU, 1e-10);
  EXPECT_LT(V_LV, 0);
  // The weights are the deformed area, in grid cells.
  EXPECT_NEAR(total(M) * grid.dx * grid.dx, total(element_areas(mesh, x)), 1e-11);
  const Values constant = diffusion_conservative(grid, mesh, x, Values(grid.size(), 0.7));
  EXPECT_TRUE(all_close(constant, Values(grid.size()), grid.columns, {}));
}

TEST(ReferenceExcitation, ConservativeFormIsTheGradientOfTheCellEnergy) {
  // A single sheared element with one cell: E = 1/2 area grad V . g grad V for a linear V.
  const Grid cell{2, 2, 0.6};
  const Mesh one{1, 1, 0.6};
  const Values x = mapped(one, [](double X1, double X2) {
    return std::array{1.2 * X1 + 0.3 * X2, 0.8 * X2};
  });
  const double a = 0.4, b = -0.7;
  const Values V = sampled(cell, [&](double X1, double X2) { return a * X1 + b * X2; });
  const Values L = diffusion_conservative(cell, one, x, V), M = node_weights(cell, one, x);
  // F^-1 = [1/1.2, -0.3/0.96; 0, 1/0.8], grad in space = F^-T (a, b).
  const double y1 = a / 1.2, y2 = -0.3 / 0.96 * a + b / 0.8;
  double twice_energy = 0;
  for (int n = 0; n < 4; ++n) twice_energy -= M[n] * cell.dx * cell.dx * V[n] * L[n];
  EXPECT_NEAR(twice_energy, (y1 * y1 + y2 * y2) * 0.96 * 0.36, 1e-14);
}

TEST(ReferenceExcitation, FormsAreExactOnAnAffineMapInside) {
  // F = [1.2, 0.3; -0.1, 0.8]
  const Values x = mapped(mesh, [](double X1, double X2) {
    return std::array{1.2 * X1 + 0.3 * X2 + 5, -0.1 * X1 + 0.8 * X2};
  });
  const Values V = sampled(grid, [](double X1, double X2) {
    return 0.3 * X1 * X1 - 0.5 * X1 * X2 + 0.2 * X2 * X2 + X1 - 2 * X2 + 0.1;
  });
  const double C11 = 1.45, C12 = 0.28, C22 = 0.73, det = C11 * C22 - C12 * C12;
  const double expected = (C22 * 0.6 + 2 * C12 * 0.5 + C11 * 0.4) / det;
  const Values expanded = diffusion_expanded(grid, mesh, x, V);
  const Values conservative = diffusion_conservative(grid, mesh, x, V);
  for (int i = 1; i < grid.rows - 1; ++i)
    for (int j = 1; j < grid.columns - 1; ++j) {
      EXPECT_NEAR(expanded[grid.node(i, j)], expected, 1e-12) << i << ' ' << j;
      EXPECT_NEAR(conservative[grid.node(i, j)], expected, 1e-12) << i << ' ' << j;
    }
}

TEST(ReferenceExcitation, ExpandedFormLetsNoFluxThroughAnEdge) {
  const Values x = mapped(mesh, [](double X1, double X2) {
    return std::array{1.2 * X1 + 0.3 * X2, -0.1 * X1 + 0.8 * X2};
  });
  const double C11 = 1.45, C12 = 0.28, C22 = 0.73;  // g12/g11 = -C12/C22, g12/g22 = -C12/C11
  // Linear fields whose flux is along X2, or along X1: nothing diffuses, also on the edges they
  // run along. At the nodes next to a corner the corner's vanishing gradient enters V_,12.
  const Values along_2 = diffusion_expanded(
      grid, mesh, x, sampled(grid, [&](double X1, double X2) { return X2 + C12 / C22 * X1; }));
  const Values along_1 = diffusion_expanded(
      grid, mesh, x, sampled(grid, [&](double X1, double X2) { return X1 + C12 / C11 * X2; }));
  for (int i = 2; i < grid.rows - 2; ++i)
    for (const int j : {0, grid.columns - 1})
      EXPECT_NEAR(along_2[grid.node(i, j)], 0, 1e-13) << i << ' ' << j;
  for (int j = 2; j < grid.columns - 2; ++j)
    for (const int i : {0, grid.rows - 1}) EXPECT_NEAR(along_1[grid.node(i, j)], 0, 1e-13) << i << ' ' << j;
}

// Largest error inside of a form against 1/sqrt C (sqrt C g^ML V_,L)_,M on the map
// x = (X1 (1 + 0.05 X2), X2 (1 + 0.03 X1)), which every mesh of bilinear elements represents.
template <class Form>
double error_on_a_bilinear_map(const Form& form, int refinement) {
  const Grid g{8 * refinement + 1, 8 * refinement + 1, 0.6 / refinement};
  const Mesh m{2, 2, 2.4};
  const Values x = mapped(m, [](double X1, double X2) {
    return std::array{X1 * (1 + 0.05 * X2), X2 * (1 + 0.03 * X1)};
  });
  const Function V = [](double X1, double X2) { return std::sin(0.7 * X1) * std::cos(0.5 * X2 + 0.2); };
  const auto flux = [&](double X1, double X2) {
    const Tensor F{{{1 + 0.05 * X2, 0.05 * X1}, {0.03 * X2, 1 + 0.03 * X1}}}, f = inverse(F);
    const double V_1 = 0.7 * std::cos(0.7 * X1) * std::cos(0.5 * X2 + 0.2);
    const double V_2 = -0.5 * std::sin(0.7 * X1) * std::sin(0.5 * X2 + 0.2);
    std::array<double, 2> q{};
    for (int M = 0; M < 2; ++M)
      for (int k = 0; k < 2; ++k) q[M] += determinant(F) * f[M][k] * (f[0][k] * V_1 + f[1][k] * V_2);
    return q;
  };
  const Values result = form(g, m, x, sampled(g, V));
  double largest = 0;
  for (int i = refinement; i < g.rows - refinement; ++i)
    for (int j = refinement; j < g.columns - refinement; ++j) {
      const double X1 = j * g.dx, X2 = i * g.dx, s = 1e-4;
      const double sqrt_C = (1 + 0.05 * X2) * (1 + 0.03 * X1) - 0.05 * X1 * 0.03 * X2;
      const double exact =
          (flux(X1 + s, X2)[0] - flux(X1 - s, X2)[0] + flux(X1, X2 + s)[1] - flux(X1, X2 - s)[1]) /
          (2 * s * sqrt_C);
      largest = std::max(largest, std::abs(result[g.node(i, j)] - exact));
    }
  return largest;
}

TEST(ReferenceExcitation, BothFormsAreSecondOrderOnABilinearMap) {
  const double expanded_4 = error_on_a_bilinear_map(diffusion_expanded, 4);
  const double expanded_8 = error_on_a_bilinear_map(diffusion_expanded, 8);
  const auto five_point = [](const Grid& g, const Mesh& m, const Values& x, const Values& V) {
    return diffusion_conservative(g, m, x, V);
  };
  const double conservative_4 = error_on_a_bilinear_map(five_point, 4);
  const double conservative_8 = error_on_a_bilinear_map(five_point, 8);
  EXPECT_LT(expanded_8, 1e-3);
  EXPECT_LT(conservative_8, 1e-3);
  EXPECT_NEAR(std::log2(expanded_4 / expanded_8), 2, 0.1);
  EXPECT_NEAR(std::log2(conservative_4 / conservative_8), 2, 0.1);
}

TEST(ReferenceExcitation, StepIsTheHandCase) {
  solver::ExcitationSettings p;
  solver::TensionSettings tension;
  const ExcitationState old{{0.5, 0.04}, {1.0, 0.2}, {3.0, 5.0}};
  const auto next = euler_step(p, tension, 0.02, old, {0.25, 0}, {0.1, 0});
  // -8 0.5 0.4 (-0.5) - 0.5 + 0.25 + 0.1 = 0.65
  EXPECT_NEAR(next.V[0], 0.5 + 0.02 * 0.65, 1e-15);
  // (0.01 + 0.12/0.8)(-1 - 4 (-0.6)) = 0.16 1.4
  EXPECT_NEAR(next.r[0], 1 + 0.02 * 0.16 * 1.4, 1e-15);
  EXPECT_NEAR(next.Ta[0], 3 + 0.02 * 0.1 * (47.9 * 0.5 - 3), 1e-15);
  // below the threshold
  EXPECT_NEAR(next.Ta[1], 5 + 0.02 * (47.9 * 0.04 - 5), 1e-15);
}

TEST(ReferenceExcitation, CellRecoversWhenItShould) {
  // From V = 0.5, r = 0 at dt = 0.02 a cell falls below 0.1 at 38.714.
  solver::ExcitationSettings p;
  ExcitationState state{{0.5}, {0}, {0}};
  double before = 0, t = 0;
  while (state.V[0] >= 0.1) {
    before = state.V[0];
    state = euler_step(p, {}, 0.02, state, {0}, {0});
    t += 0.02;
  }
  EXPECT_NEAR(t - 0.02 * (0.1 - state.V[0]) / (before - state.V[0]), 38.714, 5e-4);
}

TEST(ReferenceExcitation, FindsTheTipsOfAnAnalyticField) {
  // Zeros of a product of two complex factors, one of them conjugate, turned by any phase.
  const double x1 = 3.13, y1 = 2.05, x2 = 6.97, y2 = 4.4;
  for (const double phase : {0.0, 0.4, 1.3, 2.9, 4.6}) {
    const auto field = [&](double X1, double X2) {
      const std::complex<double> z{X1 - x1, X2 - y1}, w{X1 - x2, -(X2 - y2)};
      return std::polar(1.0, phase) * z * w;
    };
    const Values V = sampled(grid, [&](double X1, double X2) { return 0.5 + field(X1, X2).real(); });
    const Values rate = sampled(grid, [&](double X1, double X2) { return field(X1, X2).imag(); });
    const auto tips = phase_singularities(grid, V, rate);
    ASSERT_EQ(tips.size(), 2U);
    EXPECT_EQ(tips[0].charge, 1);
    EXPECT_EQ(tips[1].charge, -1);
    // The interpolation error of a quadratic field is below dx^2/8 of its second derivatives.
    EXPECT_NEAR(tips[0].x, x1, 0.05);
    EXPECT_NEAR(tips[0].y, y1, 0.05);
    EXPECT_NEAR(tips[1].x, x2, 0.05);
    EXPECT_NEAR(tips[1].y, y2, 0.05);
  }
}

TEST(ReferenceExcitation, TipIsTheExactRootOfBilinearFields) {
  for (const double phase : {0.0, 0.7, 1.57, 3.0}) {
    const auto p = [](double X1, double X2) { return (X1 - 3.13) * (1 + 0.2 * X2); };
    const auto q = [](double X1, double X2) { return (X2 - 2.05) * (2 - 0.1 * X1); };
    const double c = std::cos(phase), s = std::sin(phase);
    const Values V = sampled(grid, [&](double a, double b) { return 0.5 + c * p(a, b) - s * q(a, b); });
    const Values rate = sampled(grid, [&](double a, double b) { return s * p(a, b) + c * q(a, b); });
    const auto tips = phase_singularities(grid, V, rate);
    ASSERT_EQ(tips.size(), 1U);
    EXPECT_EQ(tips[0].charge, 1);
    EXPECT_NEAR(tips[0].x, 3.13, 1e-12);
    EXPECT_NEAR(tips[0].y, 2.05, 1e-12);
  }
}

TEST(ReferenceExcitation, RestHasNoTips) {
  EXPECT_TRUE(phase_singularities(grid, Values(grid.size()), Values(grid.size())).empty());
}

}  // namespace
}  // namespace myowave::reference
