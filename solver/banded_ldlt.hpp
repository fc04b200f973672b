// A = L D L^T of a symmetric band matrix, without pivoting, in panels of eight columns.
//
// A small mesh numbered row by row has a narrow band: 55 below the diagonal at 25 x 25 elements.
// Filling the whole band costs more operations than a fill-reducing ordering, but they are long
// vector operations on a window that stays in the first-level cache.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace myowave::solver {

enum class Factorization { positive_definite, indefinite, failed };

class BandedLdlt {
 public:
  // Pattern of the lower triangle in compressed rows, columns ascending. It is copied.
  BandedLdlt(std::span<const int> row_begin, std::span<const int> column);

  // Entries below the diagonal in the widest row of a pattern.
  static int bandwidth(std::span<const int> row_begin, std::span<const int> column);

  // Values in the order of the pattern. failed: a pivot is zero or not finite, and there is no factor.
  Factorization factorize(std::span<const double> values);

  // solution = A^-1 rhs with the last factor; both of length n, and they may be the same.
  void solve(std::span<const double> rhs, std::span<double> solution) const;

 private:
  static constexpr int panel = 8;

  double* window_row(int i) { return window_.data() + static_cast<std::size_t>(i % window_rows_) * width_; }
  void load_row(int i, std::span<const double> values);
  bool factorize_panel(int first, int columns, int rows);
  void update_behind_panel(int first, int rows);

  int n_ = 0;
  int band_ = 0;         // entries below the diagonal
  int width_ = 0;        // of a row of the window: band and diagonal, padded
  int window_rows_ = 0;  // rows that one panel touches
  std::vector<int> row_begin_, column_;
  std::vector<double> window_;  // row i at i mod window_rows_, entry (i, j) at j - i + band_
  std::vector<double> panel_;   // (panel, width): column q of L from the panel's first row on
  std::vector<double> L_;       // (n, band): entry (k + 1 + d, k) at k band_ + d
  std::vector<double> D_;       // (n)
};

}  // namespace myowave::solver
