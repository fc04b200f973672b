// Sparse LDL^T factorisation of symmetric matrices of one pattern, definite or not.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace myowave::solver {

enum class Factorization { positive_definite, indefinite, failed };

class DirectSolver {
 public:
  // Pattern of the lower triangle in compressed rows, columns ascending. It is ordered (AMD) and
  // analysed once; the spans need not outlive the call.
  DirectSolver(std::span<const int> row_begin, std::span<const int> column);
  ~DirectSolver();
  DirectSolver(DirectSolver&&) noexcept;
  DirectSolver& operator=(DirectSolver&&) noexcept;

  // A = L D L^T without pivoting, values in the order of `column`. failed: a pivot is zero or not
  // finite, and there is no factor.
  Factorization factorize(std::span<const double> values);

  // solution = A^-1 rhs with the last factor.
  void solve(std::span<const double> rhs, std::span<double> solution);

  // Entries of L that the ordering needs.
  std::int64_t factor_entries() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace myowave::solver
