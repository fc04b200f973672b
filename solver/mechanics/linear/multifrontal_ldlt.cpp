#include "solver/mechanics/linear/multifrontal_ldlt.hpp"

#include <algorithm>
#include <utility>

#include "solver/mechanics/linear/block_operations.hpp"

namespace myowave::solver {

using namespace block;

namespace {

int blocks_of(int entries) { return (entries + width - 1) / width; }

// Offset of row `place` in a column of blocks that starts with row 0.
int row_offset(int place) { return place / width * width * width + place % width; }

}  // namespace

MultifrontalLdlt::MultifrontalLdlt(std::span<const int> row_begin, std::span<const int> column,
                                   const Supernodes& supernodes)
    : n_(static_cast<int>(row_begin.size()) - 1),
      permutation_(supernodes.permutation),
      value_(column.size()),
      permuted_(n_) {
  std::vector<int> front_of(n_);
  make_fronts(supernodes, front_of);
  link_fronts(front_of);
  place_values(row_begin, column, front_of);
}

void MultifrontalLdlt::make_fronts(const Supernodes& supernodes, std::span<int> front_of) {
  const int count = static_cast<int>(supernodes.first_column.size()) - 1;
  std::size_t L_blocks = 0;
  int diagonal_blocks = 0, largest = 0;
  for (int s = 0; s < count; ++s) {
    Front front{};
    front.first_column = supernodes.first_column[s];
    front.columns = supernodes.first_column[s + 1] - front.first_column;
    for (int c = 0; c < front.columns; ++c) front_of[front.first_column + c] = s;
    front.row_begin = static_cast<int>(row_.size());
    row_.insert(row_.end(), supernodes.row.begin() + supernodes.row_begin[s] + front.columns,
                supernodes.row.begin() + supernodes.row_begin[s + 1]);
    front.rows = static_cast<int>(row_.size()) - front.row_begin;
    front.column_blocks = blocks_of(front.columns);
    front.blocks = front.column_blocks + blocks_of(front.rows);
    front.first_block = diagonal_blocks;
    front.L_begin = L_blocks;
    diagonal_blocks += front.column_blocks;
    L_blocks += column_begin(front.blocks, front.column_blocks);
    largest = std::max(largest, front.blocks);
    fronts_.push_back(front);
  }
  L_.resize(L_blocks);
  inverse_rows_.resize(diagonal_blocks);
  D_.resize(diagonal_blocks);
  inverse_D_.resize(diagonal_blocks);
  scaled_row_.resize(largest);
  x_.resize(largest);
}

int MultifrontalLdlt::place_of(const Front& front, int r) const {
  if (r < front.first_column + front.columns) return r - front.first_column;
  const auto begin = row_.begin() + front.row_begin;
  return front.column_blocks * width +
         static_cast<int>(std::lower_bound(begin, begin + front.rows, r) - begin);
}

void MultifrontalLdlt::link_fronts(std::span<const int> front_of) {
  parent_offset_.resize(row_.size());
  std::size_t depth = 0, deepest = 0;
  std::vector<std::size_t> children_depth(fronts_.size(), 0);
  for (std::size_t s = 0; s < fronts_.size(); ++s) {
    Front& front = fronts_[s];
    front.parent = front.rows > 0 ? front_of[row_[front.row_begin]] : -1;
    for (int k = front.row_begin; k < front.row_begin + front.rows; ++k)
      parent_offset_[k] = row_offset(place_of(fronts_[front.parent], row_[k]));
    deepest = std::max(deepest, depth + front.update_blocks());
    depth += front.update_blocks() - children_depth[s];
    if (front.parent >= 0) children_depth[front.parent] += front.update_blocks();
  }
  updates_.resize(deepest);
}

void MultifrontalLdlt::place_values(std::span<const int> row_begin, std::span<const int> column,
                                    std::span<const int> front_of) {
  std::vector<int> position(n_);
  for (int c = 0; c < n_; ++c) position[permutation_[c]] = c;
  const auto front_at = [&](int i, int j) { return front_of[std::min(position[i], position[j])]; };
  std::vector<int> next(fronts_.size() + 1);
  for (int i = 0; i < n_; ++i)
    for (int slot = row_begin[i]; slot < row_begin[i + 1]; ++slot) ++next[front_at(i, column[slot]) + 1];
  for (std::size_t s = 0; s < fronts_.size(); ++s) {
    next[s + 1] += next[s];
    fronts_[s].value_begin = next[s];
    fronts_[s].value_end = next[s + 1];
  }
  for (int i = 0; i < n_; ++i) {
    for (int slot = row_begin[i]; slot < row_begin[i + 1]; ++slot) {
      const int s = front_at(i, column[slot]);
      const auto [c, r] = std::minmax(position[i], position[column[slot]]);
      const Front& front = fronts_[s];
      const int local = c - front.first_column, K = local / width;
      const auto begin = static_cast<int>(column_begin(front.blocks, K)) - K;
      value_[next[s]++] = {slot,
                           begin * width * width + local % width * width + row_offset(place_of(front, r))};
    }
  }
}

Factorization MultifrontalLdlt::factorize(std::span<const double> values) {
  // Of every front its children's updates are the last on the stack.
  std::vector<std::pair<int, std::size_t>> stack;
  std::size_t top = 0;
  for (int s = 0; s < static_cast<int>(fronts_.size()); ++s) {
    const Front& front = fronts_[s];
    Block* const L = L_.data() + front.L_begin;
    Block* const update = updates_.data() + top;
    std::fill_n(L->at, column_begin(front.blocks, front.column_blocks) * width * width, 0.0);
    if (front.rows > 0) std::fill_n(update->at, front.update_blocks() * width * width, 0.0);
    for (int k = front.value_begin; k < front.value_end; ++k) L->at[value_[k].entry] = values[value_[k].slot];
    for (int c = front.columns; c < front.column_blocks * width; ++c)
      L[column_begin(front.blocks, c / width)].at[c % width * (width + 1)] = 1;
    std::size_t begin = top;
    while (!stack.empty() && fronts_[stack.back().first].parent == s) {
      begin = stack.back().second;
      add_to_parent(fronts_[stack.back().first], updates_.data() + begin, front, L, update);
      stack.pop_back();
    }
    if (!eliminate(front, L, update)) return Factorization::failed;
    if (front.rows > 0) {
      std::copy_n(update, front.update_blocks(), updates_.data() + begin);
      stack.emplace_back(s, begin);
    }
    top = begin + (front.rows > 0 ? front.update_blocks() : 0);
  }
  for (const BlockVector& D : D_)
    for (const double d : D.at)
      if (!(d > 0)) return Factorization::indefinite;
  return Factorization::positive_definite;
}

void MultifrontalLdlt::add_to_parent(const Front& child, const Block* update, const Front& parent, Block* L,
                                     Block* parent_update) {
  constexpr int entries = width * width;
  const int* const offset = parent_offset_.data() + child.row_begin;
  const int update_blocks = child.blocks - child.column_blocks;
  for (int a = 0; a < child.rows; ++a) {
    const int K = offset[a] / entries;
    Block* const column =
        K < parent.column_blocks
            ? L + column_begin(parent.blocks, K)
            : parent_update + column_begin(parent.blocks - parent.column_blocks, K - parent.column_blocks);
    double* const to = column->at + offset[a] % width * width - K * entries;
    const int k = a / width;
    const double* from = update[column_begin(update_blocks, k)].at + a % width * width;
    for (int first = k * width; first < child.rows; first += width, from += entries) {
      const int end = std::min(first + width, child.rows);
      for (int b = std::max(a, first); b < end; ++b) to[offset[b]] += from[b - first];
    }
  }
}

bool MultifrontalLdlt::eliminate(const Front& front, Block* L, Block* update) {
  const auto block_at = [&](int I, int J) { return L[column_begin(front.blocks, J) + I - J].at; };
  BlockVector* const D = D_.data() + front.first_block;
  BlockVector* const inverse_D = inverse_D_.data() + front.first_block;
  for (int K = 0; K < front.blocks; ++K) {
    const bool own = K < front.column_blocks;
    const int before = std::min(K, front.column_blocks);
    Block* const column =
        own ? L + column_begin(front.blocks, K)
            : update + column_begin(front.blocks - front.column_blocks, K - front.column_blocks);
    for (int J = 0; J < before; ++J) scale(block_at(K, J), D[J].at, scaled_row_[J].at);
    BlockStack<1> diagonal;
    diagonal.load(column->at);
    for (int J = 0; J < before; ++J) subtract_product<1>(diagonal, block_at(K, J), scaled_row_[J].at);
    diagonal.store(column->at);
    if (own &&
        !factorize_diagonal(column->at, D[K].at, inverse_D[K].at, inverse_rows_[front.first_block + K].at))
      return false;
    int I = K + 1;
    const auto below = [&]<int rows>(BlockStack<rows>& stack) {
      double* const blocks = column[I - K].at;
      stack.load(blocks);
      for (int J = 0; J < before; ++J) subtract_product<rows>(stack, block_at(I, J), scaled_row_[J].at);
      own ? divide(stack, column->at, inverse_D[K].at, blocks) : stack.store(blocks);
    };
    for (; I + 1 < front.blocks; I += 2) {
      BlockStack<2> stack;
      below(stack);
    }
    if (I < front.blocks) {
      BlockStack<1> stack;
      below(stack);
    }
  }
  return true;
}

void MultifrontalLdlt::solve(std::span<const double> rhs, std::span<double> solution) {
  double* const x = x_.data()->at;
  for (int c = 0; c < n_; ++c) permuted_[c] = rhs[permutation_[c]];
  for (const Front& front : fronts_) {
    const Block* const L = L_.data() + front.L_begin;
    double* const below = x + front.column_blocks * width;
    std::copy_n(permuted_.data() + front.first_column, front.columns, x);
    std::fill(x + front.columns, x + front.blocks * width, 0.0);
    for (int K = 0; K < front.column_blocks; ++K) {
      const Block* const column = L + column_begin(front.blocks, K);
      double* const y = x + K * width;
      lanes(y) = times(column->at, y);
      for (int I = K + 1; I < front.blocks; ++I) lanes(x + I * width) -= times(column[I - K].at, y);
    }
    std::copy_n(x, front.columns, permuted_.data() + front.first_column);
    for (int k = 0; k < front.rows; ++k) permuted_[row_[front.row_begin + k]] += below[k];
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const Block* const L = L_.data() + front->L_begin;
    double* const below = x + front->column_blocks * width;
    std::copy_n(permuted_.data() + front->first_column, front->columns, x);
    std::fill(x + front->columns, x + front->blocks * width, 0.0);
    for (int k = 0; k < front->rows; ++k) below[k] = permuted_[row_[front->row_begin + k]];
    for (int K = front->column_blocks - 1; K >= 0; --K) {
      const Block* const column = L + column_begin(front->blocks, K);
      Lanes product[width] = {};
      for (int I = K + 1; I < front->blocks; ++I) {
#pragma GCC unroll 8
        for (int q = 0; q < width; ++q)
          product[q] += lanes(column[I - K].at + q * width) * lanes(x + I * width);
      }
      alignas(64) double z[width];
      lanes(z) = lanes(x + K * width) * lanes(inverse_D_[front->first_block + K].at);
      subtract_sums(product, z);
      lanes(x + K * width) = times(inverse_rows_[front->first_block + K].at, z);
    }
    std::copy_n(x, front->columns, permuted_.data() + front->first_column);
  }
  for (int c = 0; c < n_; ++c) solution[permutation_[c]] = permuted_[c];
}

}  // namespace myowave::solver
