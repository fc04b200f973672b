// One element: against the formulas written out with all indices; residual against energy, tangent against
// residual; edge loads as forces on the edge against the bulk term.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/elastic/element.hpp"
#include "tests/support/finite_difference.hpp"

namespace myowave::elastic {
namespace {

using test::derivative;

constexpr double h = 6;
constexpr double tension[gauss_points] = {3, 25, 40, 11};
const ElementNodes bent{{{0.5, -0.4}, {6.6, 0.9}, {-0.8, 5.1}, {5.2, 7.0}}};

const Membrane loads[] = {{.passive = {}, .load = {}},
                          {.passive = {}, .load = {.follower = 10, .dead = 0}},
                          {.passive = {}, .load = {.follower = 0, .dead = -4}}};

ElementNodes moved(const ElementNodes& element, int dof, double step) {
  ElementNodes out = element;
  out.x[dof / 2][dof % 2] += step;
  return out;
}

double entry(const ElementLinearization& element, int a, int b) {
  return element.K[tangent_entry(std::max(a, b), std::min(a, b))];
}

// R and K as the sums over all indices: R_(n,j) = w F_jN S_MN Psi_n,M and
// K = w [B^T D B + delta_ij Psi_n,M S_MN Psi_m,N], D_MNPQ from the formula for dS/dE.
struct Reference {
  std::array<double, 8> R{};
  std::array<std::array<double, 8>, 8> K{};
};

Reference reference(const Membrane& membrane, const ElementNodes& element) {
  Reference out;
  for (int q = 0; q < 4; ++q) {
    const double xi[2] = {gauss_coordinate(q % 2), gauss_coordinate(q / 2)};
    double gradient[4][2];
    for (int c = 0; c < 4; ++c) {
      const double s1 = c % 2 ? 1 : -1, s2 = c / 2 ? 1 : -1;
      gradient[c][0] = s1 * (0.5 + s2 * (xi[1] - 0.5)) / h;
      gradient[c][1] = s2 * (0.5 + s1 * (xi[0] - 0.5)) / h;
    }
    double F[2][2] = {}, C[2][2] = {}, g[2][2], S[2][2], D[2][2][2][2];
    for (int c = 0; c < 4; ++c) {
      for (int i = 0; i < 2; ++i) {
        for (int M = 0; M < 2; ++M) F[i][M] += element.x[c][i] * gradient[c][M];
      }
    }
    for (int M = 0; M < 2; ++M) {
      for (int N = 0; N < 2; ++N) C[M][N] = F[0][M] * F[0][N] + F[1][M] * F[1][N];
    }
    const double A = C[0][0] * C[1][1] - C[0][1] * C[1][0], t = C[0][0] + C[1][1], J = std::sqrt(A);
    g[0][0] = C[1][1] / A;
    g[1][1] = C[0][0] / A;
    g[0][1] = g[1][0] = -C[0][1] / A;
    const double c1 = membrane.passive.c1, c2 = membrane.passive.c2, p = membrane.load.follower;
    const double w_t = c1 + c2 / A, w_tA = -c2 / (A * A);
    const double w_A = -c1 / (A * A) + c2 * (1 - t / (A * A)) - p / (2 * J);
    const double w_AA = 2 * (c1 + c2 * t) / (A * A * A) + p / (4 * J * J * J);
    for (int M = 0; M < 2; ++M) {
      for (int N = 0; N < 2; ++N) {
        const double I_MN = M == N;
        S[M][N] = 2 * w_t * I_MN + (2 * A * w_A + tension[q]) * g[M][N];
        for (int P = 0; P < 2; ++P) {
          for (int Q = 0; Q < 2; ++Q) {
            const double I_PQ = P == Q, II = 0.5 * (g[M][P] * g[N][Q] + g[M][Q] * g[N][P]);
            D[M][N][P][Q] = 4 * (A * w_tA * (I_MN * g[P][Q] + g[M][N] * I_PQ) +
                                 (A * A * w_AA + A * w_A) * g[M][N] * g[P][Q] - A * w_A * II) -
                            2 * tension[q] * II;
          }
        }
      }
    }
    const double weight = 0.25 * h * h;
    for (int a = 0; a < 8; ++a) {
      const int n = a / 2, i = a % 2;
      for (int M = 0; M < 2; ++M) {
        for (int N = 0; N < 2; ++N) {
          out.R[a] +=
              weight * (F[i][N] * S[M][N] - (N == 0 && M == i ? membrane.load.dead : 0)) * gradient[n][M];
        }
      }
      for (int b = 0; b < 8; ++b) {
        const int m = b / 2, j = b % 2;
        for (int M = 0; M < 2; ++M) {
          for (int N = 0; N < 2; ++N) {
            const double B_n = 0.5 * (F[i][M] * gradient[n][N] + F[i][N] * gradient[n][M]);
            if (i == j) out.K[a][b] += weight * gradient[n][M] * S[M][N] * gradient[m][N];
            for (int P = 0; P < 2; ++P) {
              for (int Q = 0; Q < 2; ++Q) {
                const double B_m = 0.5 * (F[j][P] * gradient[m][Q] + F[j][Q] * gradient[m][P]);
                out.K[a][b] += weight * B_n * D[M][N][P][Q] * B_m;
              }
            }
          }
        }
      }
    }
  }
  return out;
}

class Element : public testing::TestWithParam<int> {};

TEST_P(Element, EqualsTheFormulasWrittenOut) {
  const Membrane& membrane = loads[GetParam()];
  const Reference expected = reference(membrane, bent);
  const ElementLinearization found = linearize_element(membrane, bent, tension, h);
  for (int a = 0; a < 8; ++a) {
    EXPECT_NEAR(found.R[a], expected.R[a], 1e-12 * 10 * h) << "dof " << a;
    for (int b = 0; b < 8; ++b) {
      EXPECT_NEAR(entry(found, a, b), expected.K[a][b], 1e-12 * 100) << "dofs " << a << ", " << b;
      EXPECT_NEAR(expected.K[a][b], expected.K[b][a], 1e-12 * 100);
    }
  }
}

TEST_P(Element, ResidualIsTheDerivativeOfTheEnergy) {
  const Membrane& membrane = loads[GetParam()];
  const ElementLinearization element = linearize_element(membrane, bent, tension, h);
  for (int a = 0; a < 8; ++a) {
    const double found =
        derivative([&](double s) { return element_energy(membrane, moved(bent, a, s), tension, h); });
    EXPECT_NEAR(found, element.R[a], 1e-7 * 10 * h) << "dof " << a;
  }
}

TEST_P(Element, TangentIsTheDerivativeOfTheResidual) {
  const Membrane& membrane = loads[GetParam()];
  const ElementLinearization element = linearize_element(membrane, bent, tension, h);
  for (int b = 0; b < 8; ++b) {
    for (int a = 0; a < 8; ++a) {
      const double found = derivative(
          [&](double s) { return linearize_element(membrane, moved(bent, b, s), tension, h).R[a]; });
      EXPECT_NEAR(found, entry(element, a, b), 1e-7 * 100) << "dofs " << a << ", " << b;
    }
  }
}

TEST_P(Element, ForcesBalance) {
  const ElementLinearization element = linearize_element(loads[GetParam()], bent, tension, h);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(element.R[i] + element.R[2 + i] + element.R[4 + i] + element.R[6 + i], 0, 1e-12 * 10 * h);
  }
}

INSTANTIATE_TEST_SUITE_P(Loads, Element, testing::Values(0, 1, 2));

// The element alone has a closed boundary: corners counter-clockwise are 0, 1, 3, 2.
void expect_edge_forces(const Membrane& membrane, double p, const ElementNodes& direction) {
  const Membrane free{.passive = membrane.passive, .load = {}};
  const auto loaded = linearize_element(membrane, bent, tension, h);
  const auto unloaded = linearize_element(free, bent, tension, h);
  double force[8] = {};
  const int around[5] = {0, 1, 3, 2, 0};
  for (int k = 0; k < 4; ++k) {
    const int a = around[k], b = around[k + 1];
    const auto& x = direction.x;
    const EdgeForce f = edge_force(p, x[a][0], x[a][1], x[b][0], x[b][1]);
    for (const int end : {a, b}) {
      force[2 * end] += f.f1;
      force[2 * end + 1] += f.f2;
    }
  }
  for (int a = 0; a < 8; ++a)
    EXPECT_NEAR(unloaded.R[a] - loaded.R[a], force[a], 1e-12 * 10 * h) << "dof " << a;
}

TEST(EdgeLoad, FollowerInTheBulkIsTheForceOnTheDeformedEdges) { expect_edge_forces(loads[1], 10, bent); }

TEST(EdgeLoad, DeadInTheBulkIsTheForceOnTheUndeformedEdges) {
  expect_edge_forces(loads[2], -4, {{{0, 0}, {h, 0}, {0, h}, {h, h}}});
}

TEST(EdgeLoad, TensionPullsOutward) {
  const EdgeForce bottom = edge_force(10, 0, 0, 6, 0);
  EXPECT_DOUBLE_EQ(bottom.f1, 0);
  EXPECT_DOUBLE_EQ(bottom.f2, -30);
}

}  // namespace
}  // namespace myowave::elastic
