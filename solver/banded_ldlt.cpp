#include "solver/banded_ldlt.hpp"

#include <algorithm>
#include <cmath>

namespace myowave::solver {
namespace {

constexpr int width = BandedLdlt::tile_width;

// A column of a tile. GCC's and Clang's own vectors, because a loop over eight numbers is not kept in
// a register; a processor with narrower registers takes two or four for one.
using Lanes [[gnu::vector_size(width * sizeof(double))]] = double;

Lanes& lanes(double* column) { return *reinterpret_cast<Lanes*>(column); }
const Lanes& lanes(const double* column) { return *reinterpret_cast<const Lanes*>(column); }

// `rows` tiles below one another, in registers.
template <int rows>
struct TileStack {
  Lanes c[rows][width];

  void load(const double* tiles) {
    for (int r = 0; r < rows; ++r)
      for (int s = 0; s < width; ++s) c[r][s] = lanes(tiles + (r * width + s) * width);
  }
  void store(double* tiles) const {
    for (int r = 0; r < rows; ++r)
      for (int s = 0; s < width; ++s) lanes(tiles + (r * width + s) * width) = c[r][s];
  }
};

// The first `used` tiles of the stack -= a w^T; a has as many tiles below one another, w one.
template <int used, int rows>
inline void subtract_product(TileStack<rows>& stack, const double* a, const double* w) {
#pragma GCC unroll 8
  for (int q = 0; q < width; ++q) {
    Lanes x[used];
#pragma GCC unroll 2
    for (int r = 0; r < used; ++r) x[r] = lanes(a + (r * width + q) * width);
#pragma GCC unroll 8
    for (int s = 0; s < width; ++s)
#pragma GCC unroll 2
      for (int r = 0; r < used; ++r) stack.c[r][s] -= x[r] * w[q * width + s];
  }
}

// D and the unit lower triangle below it of one tile, by scalars: the chain of divisions is what
// takes time, and the products of other tiles overlap with it.
inline void factorize_tile(const double* tile, double (&a)[width][width], double* D, double* inverse_D) {
  for (int q = 0; q < width; ++q)
    for (int r = q; r < width; ++r) a[r][q] = tile[q * width + r];
#pragma GCC unroll 8
  for (int q = 0; q < width; ++q) {
    D[q] = a[q][q];
    inverse_D[q] = 1 / a[q][q];
    double l[width];
#pragma GCC unroll 8
    for (int s = q + 1; s < width; ++s) l[s] = a[s][q] * inverse_D[q];
#pragma GCC unroll 8
    for (int s = q + 1; s < width; ++s)
#pragma GCC unroll 8
      for (int r = s; r < width; ++r) a[r][s] -= l[s] * a[r][q];
#pragma GCC unroll 8
    for (int s = q + 1; s < width; ++s) a[s][q] = l[s];
  }
}

// The inverse of a unit lower triangle, row by row.
inline void invert(const double (&a)[width][width], double* inverse_rows) {
  Lanes row[width];
#pragma GCC unroll 8
  for (int r = 0; r < width; ++r) {
    row[r] = Lanes{};
    row[r][r] = 1;
#pragma GCC unroll 8
    for (int q = 0; q < r; ++q) row[r] -= row[q] * a[r][q];
    lanes(inverse_rows + r * width) = row[r];
  }
}

// sum_q tile(:, q) x(q)
inline Lanes times(const double* tile, const double* x) {
  Lanes even = lanes(tile) * x[0], odd = lanes(tile + width) * x[1];
#pragma GCC unroll 3
  for (int q = 2; q < width; q += 2) {
    even += lanes(tile + q * width) * x[q];
    odd += lanes(tile + (q + 1) * width) * x[q + 1];
  }
  return even + odd;
}

}  // namespace

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
  for (int J = first; J < K; ++J) {
    const double* const from = tile_column(J)[K - J].at;
    double* const to = scaled_row_[J - first].at;
    for (int q = 0; q < width; ++q) lanes(to + q * width) = lanes(from + q * width) * D_[J].at[q];
  }
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

  double a[width][width];
  factorize_tile(diagonal, a, D_[K].at, inverse_D_[K].at);
  double* const rows = inverse_rows_[K].at;
  invert(a, rows);
  for (int q = 0; q < width; ++q)
    for (int r = 0; r < width; ++r) diagonal[q * width + r] = rows[r * width + q];
  return std::all_of(D_[K].at, D_[K].at + width, [](double d) { return d != 0 && std::isfinite(d); });
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

  const double* const inverse = tile_column(K)->at;
#pragma GCC unroll 8
  for (int s = width - 1; s >= 0; --s) {
#pragma GCC unroll 2
    for (int r = 0; r < rows; ++r) {
      Lanes x = stack.c[r][s];
#pragma GCC unroll 8
      for (int q = 0; q < s; ++q) x += stack.c[r][q] * inverse[q * width + s];
      lanes(tiles + (r * width + s) * width) = x * inverse_D_[K].at[s];
    }
  }
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
    for (int q = 0; q < width; ++q)
      for (int r = 0; r < width; ++r) z[q] -= product[q][r];
    lanes(y) = times(inverse_rows_[K].at, z);
  }
  std::copy_n(x, solution.size(), solution.begin());
}

}  // namespace myowave::solver
