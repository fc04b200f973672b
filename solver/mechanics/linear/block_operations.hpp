// What is done with blocks of 8 x 8 (solver/mechanics/linear/block.hpp) of a factorisation A = L D L^T, in
// vector registers. For the solver's own sources: how these functions pass vectors depends on the flags they
// are compiled with.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/mechanics/linear/block.hpp"

namespace myowave::solver::block {

constexpr int width = block_width;

// A column of a block. GCC's and Clang's own vectors, because a loop over eight numbers is not kept in
// a register; a processor with narrower registers takes two or four for one.
using Lanes [[gnu::vector_size(width * sizeof(double))]] = double;

inline Lanes& lanes(double* column) { return *reinterpret_cast<Lanes*>(column); }
inline const Lanes& lanes(const double* column) { return *reinterpret_cast<const Lanes*>(column); }

// `rows` blocks below one another, in registers.
template <int rows>
struct BlockStack {
  Lanes c[rows][width];

  void load(const double* blocks) {
    for (int r = 0; r < rows; ++r)
      for (int s = 0; s < width; ++s) c[r][s] = lanes(blocks + (r * width + s) * width);
  }
  void store(double* blocks) const {
    for (int r = 0; r < rows; ++r)
      for (int s = 0; s < width; ++s) lanes(blocks + (r * width + s) * width) = c[r][s];
  }
};

// The first `used` blocks of the stack -= a w^T; a has as many blocks below one another, w one.
template <int used, int rows>
inline void subtract_product(BlockStack<rows>& stack, const double* a, const double* w) {
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

// D and the unit lower triangle below it of one block, by scalars: the chain of divisions is what
// takes time, and the products of other blocks overlap with it.
inline void factorize_block(const double* block, double (&a)[width][width], double* D, double* inverse_D) {
  for (int q = 0; q < width; ++q)
    for (int r = q; r < width; ++r) a[r][q] = block[q * width + r];
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

// sum_q block(:, q) x(q)
inline Lanes times(const double* block, const double* x) {
  Lanes even = lanes(block) * x[0], odd = lanes(block + width) * x[1];
#pragma GCC unroll 3
  for (int q = 2; q < width; q += 2) {
    even += lanes(block + q * width) * x[q];
    odd += lanes(block + (q + 1) * width) * x[q + 1];
  }
  return even + odd;
}

// Factorises one block of the diagonal and replaces it by the inverse of its L, column by column;
// `inverse_rows` is the same row by row. false where a pivot is zero or not finite.
inline bool factorize_diagonal(double* diagonal, double* D, double* inverse_D, double* inverse_rows) {
  double a[width][width];
  factorize_block(diagonal, a, D, inverse_D);
  invert(a, inverse_rows);
  for (int q = 0; q < width; ++q)
    for (int r = 0; r < width; ++r) diagonal[q * width + r] = inverse_rows[r * width + q];
  return std::all_of(D, D + width, [](double d) { return d != 0 && std::isfinite(d); });
}

// blocks = stack L^-T D^-1, with the inverse of L column by column.
template <int rows>
inline void divide(const BlockStack<rows>& stack, const double* inverse, const double* inverse_D,
                   double* blocks) {
#pragma GCC unroll 8
  for (int s = width - 1; s >= 0; --s) {
#pragma GCC unroll 2
    for (int r = 0; r < rows; ++r) {
      Lanes x = stack.c[r][s];
#pragma GCC unroll 8
      for (int q = 0; q < s; ++q) x += stack.c[r][q] * inverse[q * width + s];
      lanes(blocks + (r * width + s) * width) = x * inverse_D[s];
    }
  }
}

// to = D from^T, by columns of `from`.
inline void scale(const double* from, const double* D, double* to) {
  for (int q = 0; q < width; ++q) lanes(to + q * width) = lanes(from + q * width) * D[q];
}

// The sums over the lanes of eight vectors, subtracted from z.
inline void subtract_sums(const Lanes (&product)[width], double* z) {
  for (int q = 0; q < width; ++q)
    for (int r = 0; r < width; ++r) z[q] -= product[q][r];
}

}  // namespace myowave::solver::block
