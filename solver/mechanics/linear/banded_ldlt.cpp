#include "solver/mechanics/linear/banded_ldlt.hpp"

#include <algorithm>
#include <cmath>

#include "solver/mechanics/linear/tile_operations.hpp"

namespace myowave::solver {
using namespace tile;

int BandedLdlt::bandwidth(std::span<const int> row_begin, std::span<const int> column) {
  int band = 0;
  for (std::size_t i = 0; i + 1 < row_begin.size(); ++i)
    if (row_begin[i] < row_begin[i + 1]) band = std::max(band, static_cast<int>(i) - column[row_begin[i]]);
  return band;
}

BandedLdlt::BandedLdlt(std::span<const int> row_begin, std::span<const int> column)
    : n_(static_cast<int>(row_begin.size()) - 1),
      tiles_((n_ + width - 1) / width),
      reach_((bandwidth(row_begin, column) + width - 1) / width),
      place_begin_(tiles_ + 1),
      place_(column.size()),
      L_(static_cast<std::size_t>(tiles_) * (reach_ + 1)),
      inverse_rows_(tiles_),
      D_(tiles_),
      inverse_D_(tiles_),
      scaled_row_(reach_),
      x_(tiles_ + reach_) {
  for (const int j : column) ++place_begin_[j / width + 1];
  for (int K = 0; K < tiles_; ++K) place_begin_[K + 1] += place_begin_[K];
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
  for (int K = 0; K < tiles_; ++K) {
    load(K, values);
    scale_row(K);
    if (!factorize_diagonal(K)) return Factorization::failed;
    // Two tiles at a time: sixteen sums hide the latency of their additions.
    int offset = 1;
    for (; offset < reach_; offset += 2) factorize_below<2>(K, offset);
    if (offset == reach_) factorize_below<1>(K, offset);
    for (int q = 0; q < width; ++q) positive = positive && D_[K].at[q] > 0;
  }
  return positive ? Factorization::positive_definite : Factorization::indefinite;
}

void BandedLdlt::load(int K, std::span<const double> values) {
  Tile* const column = tile_column(K);
  for (int offset = 0; offset <= reach_; ++offset)
    for (int q = 0; q < width; ++q) lanes(column[offset].at + q * width) = Lanes{};
  double* const entries = column->at;
  for (int k = place_begin_[K]; k < place_begin_[K + 1]; ++k)
    entries[place_[k].entry] = values[place_[k].slot];
  for (int q = n_ - width * K; q < width; ++q) entries[q * width + q] = 1;
}

// D(J) L(K, J)^T of the tiles before the diagonal.
void BandedLdlt::scale_row(int K) {
  const int first = std::max(0, K - reach_);
  for (int J = first; J < K; ++J) scale(tile_column(J)[K - J].at, D_[J].at, scaled_row_[J - first].at);
}

// Tile (K, K): its D, and the inverse of its L in place of L. false where a pivot is zero or not finite.
bool BandedLdlt::factorize_diagonal(int K) {
  double* const diagonal = tile_column(K)->at;
  const int first = std::max(0, K - reach_);
  TileStack<1> stack;
  stack.load(diagonal);
  for (int J = first; J < K; ++J)
    subtract_product<1>(stack, tile_column(J)[K - J].at, scaled_row_[J - first].at);
  stack.store(diagonal);

  return tile::factorize_diagonal(diagonal, D_[K].at, inverse_D_[K].at, inverse_rows_[K].at);
}

// Tiles (K + offset, K), `rows` of them: L = (A - sum of earlier products) L(K, K)^-T D(K)^-1.
template <int rows>
void BandedLdlt::factorize_below(int K, int offset) {
  double* const tiles = tile_column(K)[offset].at;
  const int first = std::max(0, K - reach_);
  TileStack<rows> stack;
  stack.load(tiles);
  int J = K + offset - reach_;
  // The lower tile has one product less: the band ends above it.
  if (rows > 1 && J >= first && J < K)
    subtract_product<1>(stack, tile_column(J)[K + offset - J].at, scaled_row_[J - first].at);
  if (rows > 1) ++J;
  for (J = std::max(J, first); J < K; ++J)
    subtract_product<rows>(stack, tile_column(J)[K + offset - J].at, scaled_row_[J - first].at);

  divide(stack, tile_column(K)->at, inverse_D_[K].at, tiles);
}

void BandedLdlt::solve(std::span<const double> rhs, std::span<double> solution) {
  double* const x = x_.data()->at;
  std::copy(rhs.begin(), rhs.end(), x);
  std::fill_n(x + n_, width * x_.size() - n_, 0.0);
  for (int K = 0; K < tiles_; ++K) {
    const Tile* const column = tile_column(K);
    double* const y = x + K * width;
    lanes(y) = times(column->at, y);
    for (int offset = 1; offset <= reach_; ++offset) lanes(y + offset * width) -= times(column[offset].at, y);
  }
  for (int K = tiles_ - 1; K >= 0; --K) {
    const Tile* const column = tile_column(K);
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
