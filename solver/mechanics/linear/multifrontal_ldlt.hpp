// A = L D L^T of a sparse symmetric matrix, without pivoting: multifrontal, with dense fronts of blocks.
//
// Columns with the same rows below them form a supernode. Its front is a dense lower triangle of its
// columns and these rows: it takes up the matrix and what the supernodes before it leave for its rows,
// its columns are eliminated, and the rest is left for its parent. The operations are those of the
// ordering that the supernodes come from, at the rate of the blocks.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/mechanics/linear/banded_ldlt.hpp"
#include "solver/mechanics/linear/block.hpp"

namespace myowave::solver {

// Postordered supernodes of a permuted matrix.
struct Supernodes {
  std::vector<int> permutation;   // (n): unknown that column c is
  std::vector<int> first_column;  // (supernodes + 1)
  std::vector<int> row_begin;     // (supernodes + 1)
  std::vector<int> row;           // by supernode, ascending: its columns, then the rows below them
};

class MultifrontalLdlt {
 public:
  // Pattern of the lower triangle in compressed rows, columns ascending. It is copied.
  MultifrontalLdlt(std::span<const int> row_begin, std::span<const int> column, const Supernodes&);

  // Values in the order of the pattern. failed: a pivot is zero or not finite, and there is no factor.
  Factorization factorize(std::span<const double> values);

  // solution = A^-1 rhs with the last factor; both of length n, and they may be the same.
  void solve(std::span<const double> rhs, std::span<double> solution);

 private:
  // Its places: the columns, padding up to a block, the rows below, padding.
  struct Front {
    int column_blocks, blocks;
    int first_block;             // of its columns in D_
    std::size_t L_begin;         // its columns of blocks in L_
    int parent;                  // -1: none
    int row_begin, rows;         // below, in row_ and parent_offset_
    int value_begin, value_end;  // in value_
    int columns, first_column;
    std::size_t update_blocks() const { return triangle(blocks - column_blocks); }
  };
  // Where a value of the pattern goes in the columns of its front.
  struct Value {
    int slot, entry;
  };

  static std::size_t triangle(int n) { return static_cast<std::size_t>(n) * (n + 1) / 2; }
  // Column of blocks K of a lower triangle of `blocks`; its first block is the diagonal one.
  static std::size_t column_begin(int blocks, int K) { return triangle(blocks) - triangle(blocks - K); }

  // The steps of the constructor: the dense storage of each supernode, and of each column its front;
  void make_fronts(const Supernodes&, std::span<int> front_of);
  // the parent of each front, and where its rows are there;
  void link_fronts(std::span<const int> front_of);
  // where each value of the pattern goes.
  void place_values(std::span<const int> row_begin, std::span<const int> column,
                    std::span<const int> front_of);
  // Place of a permuted row in a front.
  int place_of(const Front&, int r) const;

  bool eliminate(const Front& front, Block* L, Block* update);
  void add_to_parent(const Front& child, const Block* update, const Front& parent, Block* L,
                     Block* parent_update);

  int n_ = 0;
  std::vector<int> permutation_;
  std::vector<Front> fronts_;
  std::vector<int> row_;            // permuted, below the columns of each front
  std::vector<int> parent_offset_;  // where these are in a column of blocks of the parent's front
  std::vector<Value> value_;        // by front
  std::vector<Block> L_, inverse_rows_;
  std::vector<BlockVector> D_, inverse_D_;
  std::vector<Block> updates_;  // a stack of what fronts leave for their parents
  std::vector<Block> scaled_row_;
  std::vector<double> permuted_;
  std::vector<BlockVector> x_;  // of one front
};

}  // namespace myowave::solver
