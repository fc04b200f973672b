// Sparse Cholesky factorisation of A + shift I, of a symmetric A with a fixed pattern.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace myowave::solver {

class DirectSolver {
 public:
  // Pattern of the lower triangle in compressed rows, columns ascending. It is ordered (AMD) and
  // analysed once; the spans need not outlive the call.
  DirectSolver(std::span<const int> row_begin, std::span<const int> column);
  ~DirectSolver();
  DirectSolver(DirectSolver&&) noexcept;
  DirectSolver& operator=(DirectSolver&&) noexcept;

  // A + shift I = L L^T, values in the order of `column`. False: not positive definite, and there
  // is no factor.
  bool factorize(std::span<const double> values, double shift);

  // solution = (A + shift I)^-1 rhs with the last factor.
  void solve(std::span<const double> rhs, std::span<double> solution);

  // Entries of L that the ordering needs.
  std::int64_t factor_entries() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace myowave::solver
