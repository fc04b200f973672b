// The only file that names SuiteSparse: its orderings and supernodes, and its simplicial LDL^T.
#include "solver/mechanics/linear/direct_solver.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/mechanics/linear/multifrontal_ldlt.hpp"

namespace myowave::solver {

namespace {

void check(int status, const char* what) {
  if (status >= CHOLMOD_OK) return;
  if (status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error("sparse " + std::string(what) + ": CHOLMOD status " + std::to_string(status));
}

// The pattern as CHOLMOD sees it: rows of the lower triangle are columns of the upper one.
cholmod_sparse upper_triangle(std::span<int> row_begin, std::span<int> column) {
  cholmod_sparse matrix{};
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
  return matrix;
}

// The supernodes of an ordering by nested dissection. With CHOLMOD_AMD, the analysis takes half of the
// time and a factorisation a fifth more at 250 x 250 elements.
Supernodes find_supernodes(std::span<int> row_begin, std::span<int> column) {
  cholmod_sparse matrix = upper_triangle(row_begin, column);
  cholmod_common common{};
  cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_METIS;
  common.postorder = true;
  // Supernodes merge up to twice the widths of CHOLMOD's defaults, so that their columns fill blocks
  // (bench/HISTORY.md).
  for (auto& width : common.nrelax) width *= 2;
  for (auto& zeros : common.zrelax) zeros *= 2;
  cholmod_factor* factor = cholmod_analyze(&matrix, &common);
  Supernodes result;
  if (factor) {
    const auto take = [](const void* begin, std::size_t count) {
      const auto* numbers = static_cast<const int*>(begin);
      return std::vector<int>(numbers, numbers + count);
    };
    result = {take(factor->Perm, factor->n), take(factor->super, factor->nsuper + 1),
              take(factor->pi, factor->nsuper + 1), take(factor->s, factor->ssize)};
  }
  const int status = common.status;
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  check(status, "analysis");
  return result;
}

// SuiteSparse's simplicial LDL^T. Its supernodal one knows no indefinite matrix.
struct Cholmod {
  cholmod_common common{};
  cholmod_sparse matrix{};  // the caller's pattern, which must stay, and values
  cholmod_factor* factor = nullptr;
  // Kept between solves, so that they allocate nothing.
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;

  Cholmod(std::span<int> row_begin, std::span<int> column) {
    cholmod_start(&common);
    common.print = 0;  // "not positive definite" is an answer, no message
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = false;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.postorder = true;

    matrix = upper_triangle(row_begin, column);
    factor = cholmod_analyze(&matrix, &common);
    matrix.xtype = CHOLMOD_REAL;
    try {
      check(common.status, "analysis");
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

  Factorization factorize(std::span<const double> values) {
    matrix.x = const_cast<double*>(values.data());  // only read
    cholmod_factorize(&matrix, factor, &common);
    check(common.status, "factorisation");
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
    check(common.status, "solve");
    std::copy_n(static_cast<const double*>(x->x), solution.size(), solution.begin());
  }
};

// Entries below the diagonal up to which the band is used. Factorisation and solve by band take 0.65 of
// the multifrontal time at 25 x 25 elements (54 entries), 0.95 at 40 x 40, 1.2 at 50 x 50, 2.3 at
// 100 x 100. The simplicial LDL^T takes 16 times the multifrontal time at 100 x 100, 27 at 250 x 250.
constexpr int widest_band = 88;

// Residual of a solution, relative to max|A| |x| + |b|, from which on it is refined. Rounding alone leaves
// 1e-16 to 1e-15: 1e-10 is the growth of the factor's entries by 1e5, and it changes a direction of Newton's
// method far less than the tangent changes along it.
constexpr double least_bad_residual = 1e-10;

double sum_norm(std::span<const double> x) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t i = 0; i < x.size(); ++i) sum += std::abs(x[i]);
  return sum;
}

double max_norm(std::span<const double> x) {
  double largest = 0;
#pragma omp simd reduction(max : largest)
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i]));
  return largest;
}

}  // namespace

struct DirectSolver::Impl {
  std::vector<int> row_begin, column;
  std::optional<BandedLdlt> banded;
  std::optional<MultifrontalLdlt> multifrontal;
  std::optional<Cholmod> sparse;
  Factorization last = Factorization::failed;
  std::vector<double> residual, correction;

  Impl(std::span<const int> row_begin_in, std::span<const int> column_in)
      : row_begin(row_begin_in.begin(), row_begin_in.end()), column(column_in.begin(), column_in.end()) {}

  // residual = rhs - A x
  void set_residual(std::span<const double> values, std::span<const double> rhs, std::span<const double> x) {
    residual.assign(rhs.begin(), rhs.end());
    for (std::size_t i = 0; i < x.size(); ++i) {
      double sum = 0;
      int end = row_begin[i + 1];
      if (end > row_begin[i] && column[end - 1] == static_cast<int>(i)) sum = values[--end] * x[i];
      for (int slot = row_begin[i]; slot < end; ++slot) {
        sum += values[slot] * x[column[slot]];
        residual[column[slot]] -= values[slot] * x[i];
      }
      residual[i] -= sum;
    }
  }

  bool is_accurate(std::span<const double> values, std::span<const double> rhs, std::span<const double> x) {
    set_residual(values, rhs, x);
    // What is infinite or not a number in x is so in the residual, and is not less than the bound.
    return sum_norm(residual) < least_bad_residual * (max_norm(values) * sum_norm(x) + sum_norm(rhs));
  }
};

DirectSolver::DirectSolver(std::span<const int> row_begin, std::span<const int> column, Method method)
    : impl_(std::make_unique<Impl>(row_begin, column)) {
  if (method == Method::fastest)
    method = BandedLdlt::bandwidth(row_begin, column) <= widest_band ? Method::banded : Method::multifrontal;
  if (method == Method::banded)
    impl_->banded.emplace(row_begin, column);
  else if (method == Method::multifrontal)
    impl_->multifrontal.emplace(row_begin, column, find_supernodes(impl_->row_begin, impl_->column));
  else
    impl_->sparse.emplace(impl_->row_begin, impl_->column);
}
DirectSolver::~DirectSolver() = default;
DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;

Factorization DirectSolver::factorize(std::span<const double> values) {
  const auto by = [&](auto& method) { return method.factorize(values); };
  return impl_->last = impl_->banded         ? by(*impl_->banded)
                       : impl_->multifrontal ? by(*impl_->multifrontal)
                                             : by(*impl_->sparse);
}

void DirectSolver::solve(std::span<const double> rhs, std::span<double> solution) {
  if (impl_->banded) return impl_->banded->solve(rhs, solution);
  impl_->multifrontal ? impl_->multifrontal->solve(rhs, solution) : impl_->sparse->solve(rhs, solution);
}

bool DirectSolver::solve_checked(std::span<const double> values, std::span<const double> rhs,
                                 std::span<double> solution) {
  solve(rhs, solution);
  // Positive pivots bound the factor: l_ij^2 d_j <= a_ii.
  if (impl_->last == Factorization::positive_definite || impl_->is_accurate(values, rhs, solution))
    return true;
  impl_->correction.resize(solution.size());
  solve(impl_->residual, impl_->correction);
  for (std::size_t i = 0; i < solution.size(); ++i) solution[i] += impl_->correction[i];
  return impl_->is_accurate(values, rhs, solution);
}

}  // namespace myowave::solver
