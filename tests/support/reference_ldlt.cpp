#include "tests/support/reference_ldlt.hpp"

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>

namespace myowave::reference {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Rows of the lower triangle are columns of the upper one.
Sparse upper_triangle(const SymmetricMatrix& A) {
  return Eigen::Map<const Sparse>(A.size(), A.size(), static_cast<Eigen::Index>(A.column.size()),
                                  A.row_begin.data(), A.column.data(), A.values.data());
}

Eigen::Map<const Eigen::VectorXd> vector(const std::vector<double>& x) {
  return Eigen::VectorXd::Map(x.data(), static_cast<Eigen::Index>(x.size()));
}

std::vector<double> values(const Eigen::VectorXd& x) { return {x.begin(), x.end()}; }

}  // namespace

std::vector<double> product(const SymmetricMatrix& A, const std::vector<double>& x) {
  return values(upper_triangle(A).selfadjointView<Eigen::Upper>() * vector(x));
}

std::vector<double> eigenvalues(const SymmetricMatrix& A) {
  const Eigen::MatrixXd lower = Eigen::MatrixXd(upper_triangle(A)).transpose();  // the solver reads no more
  return values(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(lower, Eigen::EigenvaluesOnly).eigenvalues());
}

struct Ldlt::Solver {
  Sparse A;

  explicit Solver(const SymmetricMatrix& matrix) : A(upper_triangle(matrix)) {}
  virtual ~Solver() = default;
  virtual bool factorize() = 0;
  virtual Eigen::VectorXd solve(const Eigen::VectorXd& b) = 0;
};

namespace {

template <class Factor>
struct SolverBy : Ldlt::Solver {
  Factor factor;

  explicit SolverBy(const SymmetricMatrix& matrix) : Solver(matrix) { factor.analyzePattern(A); }
  bool factorize() override {
    factor.factorize(A);
    return factor.info() == Eigen::Success;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) override { return factor.solve(b); }
};

std::unique_ptr<Ldlt::Solver> make_solver(Ldlt::Library library, const SymmetricMatrix& A) {
  switch (library) {
    case Ldlt::Library::eigen:
      return std::make_unique<SolverBy<Eigen::SimplicialLDLT<Sparse, Eigen::Upper>>>(A);
    case Ldlt::Library::cholmod:
      return std::make_unique<SolverBy<Eigen::CholmodSimplicialLDLT<Sparse, Eigen::Upper>>>(A);
    case Ldlt::Library::supernodal:
      return std::make_unique<SolverBy<Eigen::CholmodSupernodalLLT<Sparse, Eigen::Upper>>>(A);
  }
  return nullptr;
}

}  // namespace

Ldlt::Ldlt(Library library, const SymmetricMatrix& A) : solver_(make_solver(library, A)) {}
Ldlt::~Ldlt() = default;

bool Ldlt::factorize(std::span<const double> values) {
  std::copy(values.begin(), values.end(), solver_->A.valuePtr());
  return solver_->factorize();
}

std::vector<double> Ldlt::solve(const std::vector<double>& b) { return values(solver_->solve(vector(b))); }

}  // namespace myowave::reference
