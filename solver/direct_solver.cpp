// The only file that names SuiteSparse. The simplicial path is asked for: at the sizes of this
// model (10^3 to 10^5 unknowns, two dimensions) the supernodal one is several times slower, and it
// would call a BLAS with threads of its own.
#include "solver/direct_solver.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace myowave::solver {

namespace {

// SuiteSparse's simplicial LDL^T.
struct Cholmod {
  cholmod_common common{};
  std::vector<int> row_begin, column;
  cholmod_sparse matrix{};  // the pattern above, with the values of the caller
  cholmod_factor* factor = nullptr;
  // Kept between solves, so that they allocate nothing.
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;

  Cholmod(std::span<const int> row_begin_in, std::span<const int> column_in)
      : row_begin(row_begin_in.begin(), row_begin_in.end()), column(column_in.begin(), column_in.end()) {
    cholmod_start(&common);
    common.print = 0;  // "not positive definite" is an answer, no message
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = false;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.postorder = true;

    // Rows of the lower triangle are columns of the upper one.
    matrix.nrow = matrix.ncol = row_begin.size() - 1;
    matrix.nzmax = column.size();
    matrix.p = row_begin.data();
    matrix.i = column.data();
    matrix.stype = 1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_PATTERN;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = true;
    matrix.packed = true;
    factor = cholmod_analyze(&matrix, &common);
    matrix.xtype = CHOLMOD_REAL;
    try {
      check("analysis");
    } catch (...) {
      cholmod_finish(&common);
      throw;
    }
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  ~Cholmod() {
    cholmod_free_dense(&e, &common);
    cholmod_free_dense(&y, &common);
    cholmod_free_dense(&x, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  void check(const char* what) {
    if (common.status >= CHOLMOD_OK) return;
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error("sparse " + std::string(what) + ": CHOLMOD status " +
                             std::to_string(common.status));
  }

  Factorization factorize(std::span<const double> values) {
    matrix.x = const_cast<double*>(values.data());  // only read
    cholmod_factorize(&matrix, factor, &common);
    check("factorisation");
    if (common.status != CHOLMOD_OK || factor->minor != factor->n) return Factorization::failed;
    // D stands on the diagonal of L.
    const auto* begin = static_cast<const int*>(factor->p);
    const auto* L = static_cast<const double*>(factor->x);
    bool positive = true;
    for (std::size_t j = 0; j < factor->n; ++j) {
      const double pivot = L[begin[j]];
      if (!std::isfinite(pivot)) return Factorization::failed;
      positive = positive && pivot > 0;
    }
    return positive ? Factorization::positive_definite : Factorization::indefinite;
  }

  void solve(std::span<const double> rhs, std::span<double> solution) {
    cholmod_dense b{};
    b.nrow = b.d = b.nzmax = rhs.size();
    b.ncol = 1;
    b.x = const_cast<double*>(rhs.data());  // only read
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor, &b, nullptr, &x, nullptr, &y, &e, &common);
    check("solve");
    std::copy_n(static_cast<const double*>(x->x), solution.size(), solution.begin());
  }
};

// Entries below the diagonal up to which the band is used. It factorises faster than CHOLMOD up to
// twice this width (measured: in 0.2 of the time at 25 x 25 elements, 0.5 at 100 x 100, 0.7 at
// 200 x 200), but its memory grows as the cube of the elements a side.
constexpr int widest_band = 256;

}  // namespace

struct DirectSolver::Impl {
  std::optional<BandedLdlt> banded;
  std::optional<Cholmod> sparse;
};

DirectSolver::DirectSolver(std::span<const int> row_begin, std::span<const int> column, Method method)
    : impl_(std::make_unique<Impl>()) {
  if (method == Method::fastest)
    method = BandedLdlt::bandwidth(row_begin, column) <= widest_band ? Method::banded : Method::sparse;
  if (method == Method::banded)
    impl_->banded.emplace(row_begin, column);
  else
    impl_->sparse.emplace(row_begin, column);
}
DirectSolver::~DirectSolver() = default;
DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;

Factorization DirectSolver::factorize(std::span<const double> values) {
  return impl_->banded ? impl_->banded->factorize(values) : impl_->sparse->factorize(values);
}

void DirectSolver::solve(std::span<const double> rhs, std::span<double> solution) {
  impl_->banded ? impl_->banded->solve(rhs, solution) : impl_->sparse->solve(rhs, solution);
}

}  // namespace myowave::solver
