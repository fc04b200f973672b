// A = L D L^T of a symmetric band matrix, without pivoting, in blocks of 8 x 8.
//
// A small mesh numbered row by row has a narrow band: 55 below the diagonal at 25 x 25 elements.
// Filling the whole band costs more operations than a fill-reducing ordering, but they are products
// of blocks that stay in registers and read the last columns of blocks from the first-level cache.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/mechanics/linear/block.hpp"

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
  void solve(std::span<const double> rhs, std::span<double> solution);

 private:
  // Where a value of the pattern goes in its column of blocks.
  struct Place {
    int slot, entry;
  };

  Block* block_column(int K) { return L_.data() + static_cast<std::size_t>(K) * (reach_ + 1); }
  void load(int K, std::span<const double> values);
  void scale_row(int K);
  bool factorize_diagonal(int K);
  template <int rows>
  void factorize_below(int K, int offset);

  int n_ = 0;
  int blocks_ = 0;                   // in the diagonal, the last one filled up with ones
  int reach_ = 0;                    // blocks below the diagonal one that the band touches
  std::vector<int> place_begin_;     // (blocks + 1)
  std::vector<Place> place_;         // by block column
  std::vector<Block> L_;             // (blocks, reach + 1): block (K + offset, K); the inverse at offset 0
  std::vector<Block> inverse_rows_;  // (blocks): the same inverse, row by row
  std::vector<BlockVector> D_, inverse_D_;  // (blocks)
  std::vector<Block> scaled_row_;           // (reach): D L^T of the row of blocks under work
  std::vector<BlockVector> x_;              // (blocks + reach): the vector under work, then zeros
};

}  // namespace myowave::solver
