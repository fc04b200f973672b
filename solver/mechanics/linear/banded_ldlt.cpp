#include "solver/mechanics/linear/banded_ldlt.hpp"

#include <algorithm>
#include <cmath>

#include "solver/mechanics/linear/block_operations.hpp"

namespace myowave::solver {
using namespace block;

int BandedLdlt::bandwidth(std::span<const int> row_begin, std::span<const int> column) {
  int band = 0;
  for (std::size_t i = 0; i + 1 < row_begin.size(); ++i)
    if (row_begin[i] < row_begin[i + 1]) band = std::max(band, static_cast<int>(i) - column[row_begin[i]]);
  return band;
}

BandedLdlt::BandedLdlt(std::span<const int> row_begin, std::span<const int> column)
    : n_(static_cast<int>(row_begin.size()) - 1),
      blocks_((n_ + width - 1) / width),
      reach_((bandwidth(row_begin, column) + width - 1) / width),
      place_begin_(blocks_ + 1),
      place_(column.size()),
      L_(static_cast<std::size_t>(blocks_) * (reach_ + 1)),
      inverse_rows_(blocks_),
      D_(blocks_),
      inverse_D_(blocks_),
      scaled_row_(reach_),
      x_(blocks_ + reach_) {
  for (const int j : column) ++place_begin_[j / width + 1];
  for (int K = 0; K < blocks_; ++K) place_begin_[K + 1] += place_begin_[K];
  std::vector<int> next(place_begin_.begin(), place_begin_.end() - 1);
  for (int i = 0; i < n_; ++i) {
    for (int slot = row_begin[i]; slot < row_begin[i + 1]; ++slot) {
      const int j = column[slot], K = j / width;
      place_[next[K]++] = {slot, ((i / width - K) * width + j % width) * width + i % width};
    }
  }
}

Factorization BandedLdlt::factorize(std::span<const double> values) {
  bool positive = true;
  for (int K = 0; K < blocks_; ++K) {
    load(K, values);
    scale_row(K);
    if (!factorize_diagonal(K)) return Factorization::failed;
    // Two blocks at a time: sixteen sums hide the latency of their additions.
    int offset = 1;
    for (; offset < reach_; offset += 2) factorize_below<2>(K, offset);
    if (offset == reach_) factorize_below<1>(K, offset);
    for (int q = 0; q < width; ++q) positive = positive && D_[K].at[q] > 0;
  }
  return positive ? Factorization::positive_definite : Factorization::indefinite;
}

void BandedLdlt::load(int K, std::span<const double> values) {
  Block* const column = block_column(K);
  for (int offset = 0; offset <= reach_; ++offset)
    for (int q = 0; q < width; ++q) lanes(column[offset].at + q * width) = Lanes{};
  double* const entries = column->at;
  for (int k = place_begin_[K]; k < place_begin_[K + 1]; ++k)
    entries[place_[k].entry] = values[place_[k].slot];
  for (int q = n_ - width * K; q < width; ++q) entries[q * width + q] = 1;
}

// D(J) L(K, J)^T of the blocks before the diagonal.
void BandedLdlt::scale_row(int K) {
  const int first = std::max(0, K - reach_);
  for (int J = first; J < K; ++J) scale(block_column(J)[K - J].at, D_[J].at, scaled_row_[J - first].at);
}

// Block (K, K): its D, and the inverse of its L in place of L. false where a pivot is zero or not finite.
bool BandedLdlt::factorize_diagonal(int K) {
  double* const diagonal = block_column(K)->at;
  const int first = std::max(0, K - reach_);
  BlockStack<1> stack;
  stack.load(diagonal);
  for (int J = first; J < K; ++J)
    subtract_product<1>(stack, block_column(J)[K - J].at, scaled_row_[J - first].at);
  stack.store(diagonal);

  return block::factorize_diagonal(diagonal, D_[K].at, inverse_D_[K].at, inverse_rows_[K].at);
}

// Blocks (K + offset, K), `rows` of them: L = (A - sum of earlier products) L(K, K)^-T D(K)^-1.
template <int rows>
void BandedLdlt::factorize_below(int K, int offset) {
  double* const blocks = block_column(K)[offset].at;
  const int first = std::max(0, K - reach_);
  BlockStack<rows> stack;
  stack.load(blocks);
  int J = K + offset - reach_;
  // The lower block has one product less: the band ends above it.
  if (rows > 1 && J >= first && J < K)
    subtract_product<1>(stack, block_column(J)[K + offset - J].at, scaled_row_[J - first].at);
  if (rows > 1) ++J;
  for (J = std::max(J, first); J < K; ++J)
    subtract_product<rows>(stack, block_column(J)[K + offset - J].at, scaled_row_[J - first].at);

  divide(stack, block_column(K)->at, inverse_D_[K].at, blocks);
}

void BandedLdlt::solve(std::span<const double> rhs, std::span<double> solution) {
  double* const x = x_.data()->at;
  std::copy(rhs.begin(), rhs.end(), x);
  std::fill_n(x + n_, width * x_.size() - n_, 0.0);
  for (int K = 0; K < blocks_; ++K) {
    const Block* const column = block_column(K);
    double* const y = x + K * width;
    lanes(y) = times(column->at, y);
    for (int offset = 1; offset <= reach_; ++offset) lanes(y + offset * width) -= times(column[offset].at, y);
  }
  for (int K = blocks_ - 1; K >= 0; --K) {
    const Block* const column = block_column(K);
    double* const y = x + K * width;
    Lanes product[width] = {};
    for (int offset = 1; offset <= reach_; ++offset) {
#pragma GCC unroll 8
      for (int q = 0; q < width; ++q)
        product[q] += lanes(column[offset].at + q * width) * lanes(y + offset * width);
    }
    alignas(64) double z[width];
    lanes(z) = lanes(y) * lanes(inverse_D_[K].at);
    subtract_sums(product, z);
    lanes(y) = times(inverse_rows_[K].at, z);
  }
  std::copy_n(x, solution.size(), solution.begin());
}

}  // namespace myowave::solver
