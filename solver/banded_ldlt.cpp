#include "solver/banded_ldlt.hpp"

#include <algorithm>
#include <cmath>

namespace myowave::solver {

int BandedLdlt::bandwidth(std::span<const int> row_begin, std::span<const int> column) {
  int band = 0;
  for (std::size_t i = 0; i + 1 < row_begin.size(); ++i)
    if (row_begin[i] < row_begin[i + 1]) band = std::max(band, static_cast<int>(i) - column[row_begin[i]]);
  return band;
}

BandedLdlt::BandedLdlt(std::span<const int> row_begin, std::span<const int> column)
    : n_(static_cast<int>(row_begin.size()) - 1),
      band_(bandwidth(row_begin, column)),
      width_(band_ + 2 * panel),
      window_rows_(band_ + panel),
      row_begin_(row_begin.begin(), row_begin.end()),
      column_(column.begin(), column.end()),
      window_(static_cast<std::size_t>(window_rows_) * width_),
      panel_(static_cast<std::size_t>(panel) * width_),
      L_(static_cast<std::size_t>(n_) * band_),
      D_(n_) {}

void BandedLdlt::load_row(int i, std::span<const double> values) {
  double* row = window_row(i);
  std::fill_n(row, width_, 0.0);
  for (int slot = row_begin_[i]; slot < row_begin_[i + 1]; ++slot)
    row[column_[slot] - i + band_] = values[slot];
}

Factorization BandedLdlt::factorize(std::span<const double> values) {
  int loaded = 0;
  for (int first = 0; first < n_; first += panel) {
    const int columns = std::min(panel, n_ - first);
    const int rows = std::min(band_ + panel, n_ - first);  // that the panel touches
    for (; loaded < first + rows; ++loaded) load_row(loaded, values);
    if (!factorize_panel(first, columns, rows)) return Factorization::failed;
    if (columns == panel) update_behind_panel(first, rows);
  }
  return std::all_of(D_.begin(), D_.end(), [](double d) { return d > 0; }) ? Factorization::positive_definite
                                                                           : Factorization::indefinite;
}

// Columns first ... first + columns - 1 of L and D; false where a pivot is zero or not finite.
bool BandedLdlt::factorize_panel(int first, int columns, int rows) {
  for (int q = 0; q < columns; ++q) {
    double* const column = panel_.data() + static_cast<std::size_t>(q) * width_;
    std::fill_n(column, q, 0.0);
    const int end = std::min(rows, q + band_ + 1);
    for (int r = q; r < end; ++r) column[r] = window_row(first + r)[q - r + band_];
    std::fill(column + end, column + rows, 0.0);
    for (int s = 0; s < q; ++s) {
      const double* const earlier = panel_.data() + static_cast<std::size_t>(s) * width_;
      const double factor = D_[first + s] * earlier[q];
#pragma omp simd
      for (int r = q; r < rows; ++r) column[r] -= factor * earlier[r];
    }
    const double pivot = column[q];
    if (pivot == 0 || !std::isfinite(pivot)) return false;
    D_[first + q] = pivot;
    const double inverse = 1 / pivot;
    double* const below = L_.data() + static_cast<std::size_t>(first + q) * band_;
#pragma omp simd
    for (int r = q + 1; r < rows; ++r) column[r] *= inverse;
    column[q] = 1;
    std::fill_n(std::copy(column + q + 1, column + end, below), band_ - (end - q - 1), 0.0);
  }
  return true;
}

namespace {

// Rows a and b of the window, from column 0 of both on: a -= sum_q x_q P_q, b -= sum_q y_q P_q.
template <int panel>
void update_two_rows(double* __restrict a, double* __restrict b, const double* __restrict P, int width,
                     const double* x, const double* y, int count) {
#pragma omp simd
  for (int t = 0; t < count; ++t) {
    double from_a = a[t], from_b = b[t];
    for (int q = 0; q < panel; ++q) {
      from_a -= x[q] * P[q * width + t];
      from_b -= y[q] * P[q * width + t];
    }
    a[t] = from_a;
    b[t] = from_b;
  }
}

}  // namespace

// A(i, j) -= sum over the panel's columns of L(i, q) D(q) L(j, q), behind the panel, j <= i. Rows go in
// pairs; the upper one's entry right of its diagonal is scratch.
void BandedLdlt::update_behind_panel(int first, int rows) {
  double x[panel], y[panel];
  for (int r = panel; r < rows; r += 2) {
    const bool pair = r + 1 < rows;
    for (int q = 0; q < panel; ++q) {
      const double* const column = panel_.data() + static_cast<std::size_t>(q) * width_;
      x[q] = D_[first + q] * column[r];
      y[q] = pair ? D_[first + q] * column[r + 1] : 0;
    }
    double* const a = window_row(first + r) + panel - r + band_;
    if (pair) {
      double* const b = window_row(first + r + 1) + panel - r - 1 + band_;
      update_two_rows<panel>(a, b, panel_.data() + panel, width_, x, y, r + 2 - panel);
    } else {
      for (int t = 0; t <= r - panel; ++t)
        for (int q = 0; q < panel; ++q)
          a[t] -= x[q] * panel_[static_cast<std::size_t>(q) * width_ + panel + t];
    }
  }
}

void BandedLdlt::solve(std::span<const double> rhs, std::span<double> solution) const {
  std::copy(rhs.begin(), rhs.end(), solution.begin());
  double* const x = solution.data();
  for (int k = 0; k < n_; ++k) {
    const double* const L = L_.data() + static_cast<std::size_t>(k) * band_;
    const int count = std::min(band_, n_ - 1 - k);
    const double value = x[k];
#pragma omp simd
    for (int d = 0; d < count; ++d) x[k + 1 + d] -= L[d] * value;
  }
  for (int k = n_ - 1; k >= 0; --k) {
    const double* const L = L_.data() + static_cast<std::size_t>(k) * band_;
    const int count = std::min(band_, n_ - 1 - k);
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int d = 0; d < count; ++d) sum += L[d] * x[k + 1 + d];
    x[k] = x[k] / D_[k] - sum;
  }
}

}  // namespace myowave::solver
