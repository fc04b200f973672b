// The direct solver against Eigen's and CHOLMOD's, on tangents of a sheet and on random matrices, and on
// systems made to break a factorisation without pivoting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "solver/mechanics/linear/direct_solver.hpp"
#include "tests/support/reference_ldlt.hpp"
#include "tests/support/reference_mechanics.hpp"

namespace myowave::solver {
namespace {

using reference::Ldlt;
using reference::SymmetricMatrix;
using Vector = std::vector<double>;

struct System {
  std::string name;
  SymmetricMatrix A;
};

Vector random_vector(int size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector x(size);
  for (double& value : x) value = uniform(engine);
  return x;
}

// Tension between 0 and 40 kPa, steep within an element: a spiral in the middle of the sheet, turned by
// `angle`.
Vector spiral_tension(const reference::Mesh& mesh, double angle) {
  Vector Ta;
  for (int I = 0; I < mesh.rows; ++I)
    for (int J = 0; J < mesh.columns; ++J) {
      const double x = J + 0.5 - mesh.columns / 2.0, y = I + 0.5 - mesh.rows / 2.0;
      const double phase = std::atan2(y, x) + std::hypot(x, y) - angle;
      Ta.insert(Ta.end(), 4, 20 * (1 + std::tanh(3 * std::sin(phase))));
    }
  return Ta;
}

// The rows and columns of K that are not held.
SymmetricMatrix free_tangent(const reference::Mesh& mesh, const MechanicsSettings& settings, const Vector& Ta,
                             const Vector& x) {
  const Vector K = reference::tangent(mesh, settings, Ta, x);
  const std::vector<bool> held = reference::held_coordinates(mesh, settings);
  const int size = 2 * mesh.nodes(), nodes_a_row = mesh.columns + 1;
  const auto share_an_element = [&](int a, int b) {
    return std::abs(a / nodes_a_row - b / nodes_a_row) <= 1 &&
           std::abs(a % nodes_a_row - b % nodes_a_row) <= 1;
  };
  std::vector<int> unknown;
  SymmetricMatrix A;
  for (int k = 0, unknowns = 0; k < size; ++k) {
    unknown.push_back(held[k] ? -1 : unknowns++);
    if (held[k]) continue;
    for (int l = 0; l <= k; ++l) {
      if (held[l] || !share_an_element(k / 2, l / 2)) continue;
      A.column.push_back(unknown[l]);
      A.values.push_back(K[static_cast<std::size_t>(k) * size + l]);
    }
    A.row_begin.push_back(static_cast<int>(A.column.size()));
  }
  return A;
}

SymmetricMatrix shifted(SymmetricMatrix A, double shift) {
  for (int i = 0; i < A.size(); ++i) A.values[A.row_begin[i + 1] - 1] += shift;
  return A;
}

// In equilibrium, under the tension of an instant later, and shifted to the middle of gaps of the spectrum.
std::vector<System> make_tangents() {
  std::vector<System> systems;
  for (const reference::Mesh& mesh : {reference::Mesh{12, 12, 6}, reference::Mesh{5, 13, 6}}) {
    const MechanicsSettings settings;
    const Vector Ta = spiral_tension(mesh, 0);
    const Vector x = reference::solve_equilibrium(mesh, settings, Ta, reference::undeformed(mesh));
    const std::string name = std::to_string(mesh.rows) + " x " + std::to_string(mesh.columns) + " elements, ";
    const SymmetricMatrix K = free_tangent(mesh, settings, Ta, x);
    systems.push_back({name + "equilibrium", K});
    systems.push_back({name + "later", free_tangent(mesh, settings, spiral_tension(mesh, 0.5), x)});
    const Vector lambda = reference::eigenvalues(K);
    for (const std::size_t k : {std::size_t{1}, lambda.size() / 10, lambda.size() / 2})
      systems.push_back(
          {name + std::to_string(k) + " negative", shifted(K, -(lambda[k - 1] + lambda[k]) / 2)});
  }
  return systems;
}

const std::vector<System>& tangents() {
  static const std::vector<System> systems = make_tangents();
  return systems;
}

// About three random entries a row below the diagonal, which dominates; with signs of its own: indefinite.
SymmetricMatrix random_matrix(int size, bool definite, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SymmetricMatrix A;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) {
      if (std::abs(uniform(engine)) * size > 6) continue;
      A.column.push_back(j);
      A.values.push_back(uniform(engine));
    }
    A.column.push_back(i);
    A.values.push_back((definite || i % 3 > 0 ? 1 : -1) * (8 + uniform(engine)));
    A.row_begin.push_back(static_cast<int>(A.column.size()));
  }
  return A;
}

std::vector<System> random_systems() {
  std::vector<System> systems;
  for (const int size : {1, 2, 7, 9, 33, 65, 129, 257})
    for (const bool definite : {true, false})
      systems.push_back({std::to_string(size) + " random", random_matrix(size, definite, size)});
  return systems;
}

double sum(const Vector& x) {
  double result = 0;
  for (const double value : x) result += std::abs(value);
  return result;
}

Vector minus(Vector x, const Vector& y) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= y[i];
  return x;
}

// |b - A x| over max|A| |x| + |b|, sums of magnitudes.
double relative_residual(const SymmetricMatrix& A, const Vector& b, const Vector& x) {
  double largest = 0;
  for (const double value : A.values) largest = std::max(largest, std::abs(value));
  return sum(minus(b, product(A, x))) / (largest * sum(x) + sum(b));
}

class DirectSolverAccuracy : public testing::TestWithParam<DirectSolver::Method> {
 protected:
  // Residual and error, the error against the exact solution and against those of the others.
  static void expect_accurate(const System& system) {
    SCOPED_TRACE(system.name);
    const SymmetricMatrix& A = system.A;
    const Vector lambda = reference::eigenvalues(A);
    double largest = 0, smallest = std::abs(lambda[0]);
    for (const double l : lambda) {
      largest = std::max(largest, std::abs(l));
      smallest = std::min(smallest, std::abs(l));
    }
    DirectSolver solver(A.row_begin, A.column, GetParam());
    ASSERT_EQ(solver.factorize(A.values),
              lambda[0] > 0 ? Factorization::positive_definite : Factorization::indefinite);
    const Vector exact = random_vector(A.size(), 1), b = product(A, exact);
    Vector x(A.size());
    solver.solve(b, x);
    EXPECT_LT(relative_residual(A, b, x), 1e-12);
    const double tolerance = 1e-14 * largest / smallest * sum(exact);
    EXPECT_LT(sum(minus(x, exact)), tolerance);
    for (const auto library : {Ldlt::Library::eigen, Ldlt::Library::cholmod}) {
      Ldlt other(library, A);
      ASSERT_TRUE(other.factorize(A.values));
      EXPECT_LT(sum(minus(x, other.solve(b))), tolerance);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(, DirectSolverAccuracy,
                         testing::Values(DirectSolver::Method::banded, DirectSolver::Method::multifrontal,
                                         DirectSolver::Method::sparse));

TEST_P(DirectSolverAccuracy, SolvesTangentsAsEigenAndCholmodDo) {
  int indefinite = 0;
  for (const System& system : tangents()) {
    expect_accurate(system);
    indefinite += reference::eigenvalues(system.A)[0] < 0;
  }
  EXPECT_EQ(indefinite, 8);  // all but the two in equilibrium
}

TEST_P(DirectSolverAccuracy, SolvesRandomMatricesAsEigenAndCholmodDo) {
  for (const System& system : random_systems()) expect_accurate(system);
}

// Full, with a diagonal of that size: each pivot is about as small until rounding fills it.
SymmetricMatrix small_diagonal(int size, double diagonal, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SymmetricMatrix A;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i; ++j) {
      A.column.push_back(j);
      A.values.push_back(uniform(engine) * (i == j ? diagonal : 1));
    }
    A.row_begin.push_back(static_cast<int>(A.column.size()));
  }
  return A;
}

// Full, and its third row is the second one as far as the diagonal, where they differ by `gap`: so does the
// third leading minor from zero. The matrix itself is as regular as a random one.
SymmetricMatrix singular_minor(int size, double gap, unsigned seed) {
  SymmetricMatrix A = small_diagonal(size, 1, seed);
  const double* second = &A.values[A.row_begin[1]];
  double* third = &A.values[A.row_begin[2]];
  third[0] = second[0];
  third[1] = second[1];
  third[2] = second[1] + gap;
  return A;
}

// [s I, B; B^T, -s I], as of a constraint that is hardly softened.
SymmetricMatrix saddle(int size, double s, unsigned seed) {
  SymmetricMatrix A = small_diagonal(size, s, seed);
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < i; ++j)
      if ((i < size / 2) == (j < size / 2)) A.values[A.row_begin[i] + j] = 0;
  return A;
}

// What became of the solutions of systems whose factors grow.
struct Outcomes {
  int left = 0, refined = 0, refused = 0;
};

void solve_where_factors_grow(const SymmetricMatrix& A, DirectSolver::Method method, Outcomes& outcomes) {
  constexpr double bound = 1e-10;
  DirectSolver solver(A.row_begin, A.column, method);
  if (solver.factorize(A.values) == Factorization::failed) return;
  const Vector b = product(A, random_vector(A.size(), 2));
  Vector unchecked(A.size()), x(A.size());
  solver.solve(b, unchecked);
  if (!solver.solve_checked(A.values, b, x)) {
    EXPECT_FALSE(relative_residual(A, b, unchecked) < 0.9 * bound);
    ++outcomes.refused;
    return;
  }
  EXPECT_LT(relative_residual(A, b, x), 1.1 * bound);
  if (relative_residual(A, b, unchecked) < 0.9 * bound) {
    EXPECT_EQ(x, unchecked);
    ++outcomes.left;
  } else {
    ++outcomes.refined;
  }
}

TEST_P(DirectSolverAccuracy, RefinesOrRefusesWhatAGrowingFactorGetsWrong) {
  Outcomes outcomes;
  for (const int size : {2, 5, 17, 63})
    for (const double small : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16, 1e-20})
      for (unsigned seed = 0; seed < 5; ++seed) {
        solve_where_factors_grow(small_diagonal(size, small, seed), GetParam(), outcomes);
        solve_where_factors_grow(saddle(size, small, seed), GetParam(), outcomes);
        if (size > 2) solve_where_factors_grow(singular_minor(size, small, seed), GetParam(), outcomes);
      }
  EXPECT_GT(outcomes.left, 10);
  EXPECT_GT(outcomes.refined, 10);
  EXPECT_GT(outcomes.refused, 10);
}

TEST_P(DirectSolverAccuracy, LeavesAccurateSolutionsAsTheyAre) {
  for (const System& system : tangents()) {
    SCOPED_TRACE(system.name);
    DirectSolver solver(system.A.row_begin, system.A.column, GetParam());
    solver.factorize(system.A.values);
    const Vector b = random_vector(system.A.size(), 3);
    Vector unchecked(b.size()), x(b.size());
    solver.solve(b, unchecked);
    EXPECT_TRUE(solver.solve_checked(system.A.values, b, x));
    EXPECT_EQ(x, unchecked);
  }
}

// L D L^T with pivots over ten orders of magnitude, all positive. Definite factors are not checked.
TEST_P(DirectSolverAccuracy, SolvesDefiniteMatricesWithTinyPivots) {
  constexpr int size = 24;
  int definite = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    double L[size][size] = {}, D[size];
    for (int i = 0; i < size; ++i) {
      D[i] = std::pow(10.0, -10 * std::abs(uniform(engine)));
      L[i][i] = 1;
      for (int j = 0; j < i; ++j) L[i][j] = 0.3 * uniform(engine) / std::sqrt(D[j]);
    }
    SymmetricMatrix A;
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j <= i; ++j) {
        A.column.push_back(j);
        A.values.push_back(0);
        for (int k = 0; k <= j; ++k) A.values.back() += L[i][k] * D[k] * L[j][k];
      }
      A.row_begin.push_back(static_cast<int>(A.column.size()));
    }
    DirectSolver solver(A.row_begin, A.column, GetParam());
    if (solver.factorize(A.values) != Factorization::positive_definite) continue;  // by rounding
    ++definite;
    const Vector b = product(A, random_vector(size, seed));
    Vector x(size);
    EXPECT_TRUE(solver.solve_checked(A.values, b, x));
    EXPECT_LT(relative_residual(A, b, x), 1e-8) << seed;
  }
  EXPECT_GT(definite, 50);
}

}  // namespace
}  // namespace myowave::solver
