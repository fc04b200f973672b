// LDL^T factorisation of symmetric matrices of one pattern, definite or not: as a band where that is
// faster, else multifrontal with an ordering by nested dissection. `sparse` is CHOLMOD's own.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "solver/mechanics/linear/banded_ldlt.hpp"

namespace myowave::solver {

class DirectSolver {
 public:
  enum class Method { fastest, banded, multifrontal, sparse };

  // Pattern of the lower triangle in compressed rows, columns ascending. It is analysed once; the
  // spans need not outlive the call.
  DirectSolver(std::span<const int> row_begin, std::span<const int> column, Method = Method::fastest);
  ~DirectSolver();
  DirectSolver(DirectSolver&&) noexcept;
  DirectSolver& operator=(DirectSolver&&) noexcept;

  // A = L D L^T without pivoting, values in the order of `column`. failed: a pivot is zero or not
  // finite, and there is no factor.
  Factorization factorize(std::span<const double> values);

  // solution = A^-1 rhs with the last factor; its accuracy is not checked.
  void solve(std::span<const double> rhs, std::span<double> solution);

  // The same with the values of the last factor, and checked: without pivoting, the entries of the factor of
  // an indefinite matrix, and their rounding with them, can grow without bound. A solution with a residual of
  // 1e-10 of max|A| |x| + |rhs| (sums of magnitudes) or more is refined once. false: it still has it, and is
  // of no use.
  bool solve_checked(std::span<const double> values, std::span<const double> rhs, std::span<double> solution);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace myowave::solver
