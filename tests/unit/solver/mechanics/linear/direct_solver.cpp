#include "solver/mechanics/linear/direct_solver.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "solver/mechanics/mesh.hpp"
#include "tests/support/reference_ldlt.hpp"
#include "tests/support/sheets.hpp"

namespace myowave::solver {
namespace {

// [4 1 0; 1 3 -1; 0 -1 2], lower triangle by rows.
const std::vector<int> row_begin{0, 1, 3, 5}, column{0, 0, 1, 1, 2};

class DirectSolverBy : public testing::TestWithParam<DirectSolver::Method> {};
INSTANTIATE_TEST_SUITE_P(, DirectSolverBy,
                         testing::Values(DirectSolver::Method::banded, DirectSolver::Method::multifrontal,
                                         DirectSolver::Method::sparse));

TEST_P(DirectSolverBy, SolvesAHandCase) {
  DirectSolver solver(row_begin, column, GetParam());
  ASSERT_EQ(solver.factorize(std::vector<double>{4, 1, 3, -1, 2}), Factorization::positive_definite);
  std::vector<double> x(3);
  solver.solve(std::vector<double>{6, 4, 4}, x);  // of x = (1, 2, 3)
  EXPECT_NEAR(x[0], 1, 1e-15);
  EXPECT_NEAR(x[1], 2, 1e-15);
  EXPECT_NEAR(x[2], 3, 1e-15);
}

TEST_P(DirectSolverBy, ReportsAnIndefiniteMatrixAndRecovers) {
  DirectSolver solver(row_begin, column, GetParam());
  EXPECT_EQ(solver.factorize(std::vector<double>{4, 1, -3, -1, 2}), Factorization::indefinite);
  std::vector<double> y(3);
  solver.solve(std::vector<double>{6, -8, 4}, y);  // of (1, 2, 3) all the same
  EXPECT_NEAR(y[1], 2, 1e-15);
  EXPECT_EQ(solver.factorize(std::vector<double>{4, 4, 3, -1, 2}),
            Factorization::indefinite);  // indefinite, positive diagonal
  EXPECT_EQ(solver.factorize(std::vector<double>{0, 0, 0, 0, 0}), Factorization::failed);
  EXPECT_EQ(solver.factorize(std::vector<double>{4, 1, 3, -1, 2}), Factorization::positive_definite);
  std::vector<double> x(3);
  solver.solve(std::vector<double>{6, 4, 4}, x);
  EXPECT_NEAR(x[2], 3, 1e-15);
}

// The sheet of the paper, and shapes with narrow, many or a single supernode.
TEST_P(DirectSolverBy, SolvesMeshes) {
  for (const auto& grid : {elastic::ElementGrid{25, 25, 6}, {1, 1, 6}, {2, 3, 6}, {1, 40, 6}, {40, 7, 6}}) {
    const Mesh mesh = make_mesh(grid, Edges::load);
    DirectSolver solver(mesh.row_begin, mesh.column, GetParam());
    reference::SymmetricMatrix A{mesh.row_begin, mesh.column, mesh.gradient_product};
    for (int row = 0; row < mesh.unknowns; ++row) A.values[mesh.row_begin[row + 1] - 1] += 0.1;
    // The second factorisation overwrites the first.
    for (int time = 0; time < 2; ++time)
      ASSERT_EQ(solver.factorize(A.values), Factorization::positive_definite);
    test::Uniform uniform(1);
    std::vector<double> x(mesh.unknowns), found(mesh.unknowns);
    for (double& v : x) v = uniform(-1, 1);
    const std::vector<double> b = product(A, x);
    solver.solve(b, found);
    for (int a = 0; a < mesh.unknowns; ++a) EXPECT_NEAR(found[a], x[a], 1e-12);
    for (double& value : A.values) value = -value;
    EXPECT_EQ(solver.factorize(A.values), Factorization::indefinite);
    solver.solve(b, found);
    for (int a = 0; a < mesh.unknowns; ++a) EXPECT_NEAR(found[a], -x[a], 1e-12);
  }
}

}  // namespace
}  // namespace myowave::solver
