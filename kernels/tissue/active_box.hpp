// The nodes that a launch of several steps has to take (tiled_step.hpp): all but those at rest around them.
//
// V = r = Ta = 0 solves Eqs 22a-c for any parameters, and `depth` steps reach `depth` nodes far. So a node at
// rest whose neighbours up to there rest too stays as it is: of +0 a step makes +0 again, to the bit. The
// nodes that do not rest lie in a box, found from the edges of the last one inwards. What lies outside rests
// in the old state and in the arrays of the new one, so that neither is copied and a launch leaves both
// alone.
//
// With a tolerance, a node rests where |V|, |r| <= tolerance and |Ta| <= tolerance k_Ta; outside the box it
// then keeps the values of one of the last two launches that took it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "kernels/tissue/grid.hpp"

namespace myowave::tissue {

template <class Real>
class ActiveBox {
 public:
  ActiveBox(const Grid& grid, double tolerance, double k_Ta)
      : grid_(grid),
        box_(whole(grid)),
        largest_V_(ordered(Real(tolerance))),
        largest_Ta_(ordered(Real(tolerance * k_Ta))) {}

  // Part of the state of a run (solver/archive.hpp).
  template <class Archive>
  void state(Archive& archive) {
    archive(box_);
  }

  // Other steps were taken: anything can be anywhere.
  void forget() { box_ = whole(grid_); }

  // Of all members, for a launch of `depth` steps from one state to the other, both in the host's reach and
  // nobody writing to them; first_column is a multiple of `line`. Empty where all rest.
  template <class Fields>
  NodeBox find(const Fields& state, const Fields& spare, int depth, int line) {
    const auto rest = [&](const NodeBox& part) { return rests(state, part) && rests(spare, part); };
    auto& [first_row, last_row, first_column, last_column] = box_;
    const auto row = [&](int i) { return NodeBox{i, i + 1, first_column, last_column}; };
    const auto column = [&](int j) { return NodeBox{first_row, last_row, j, j + 1}; };
    while (first_row < last_row && rest(row(first_row))) ++first_row;
    if (first_row == last_row) return box_ = {};
    while (rest(row(last_row - 1))) --last_row;
    while (rest(column(first_column))) ++first_column;
    while (rest(column(last_column - 1))) --last_column;
    first_row = std::max(0, first_row - depth);
    last_row = std::min(grid_.rows, last_row + depth);
    first_column = std::max(0, first_column - depth) / line * line;
    last_column = std::min(grid_.columns, last_column + depth);
    return box_;
  }

 private:
  using Bits = std::conditional_t<sizeof(Real) == sizeof(std::uint64_t), std::uint64_t, std::uint32_t>;

  // In the order of |value|, -0 above +0: a step makes +0 of it. Compares bits, which tell a denormal number,
  // flushed in a step, from zero.
  static Bits ordered(Real value) { return std::rotl(std::bit_cast<Bits>(value), 1); }

  template <class Fields>
  bool rests(const Fields& fields, const NodeBox& part) const {
    return within(fields.r, part, largest_V_) && within(fields.V, part, largest_V_) &&
           within(fields.Ta, part, largest_Ta_);
  }

  // Without tension Ta has no member.
  template <class View>
  static bool within(const View& view, const NodeBox& part, Bits largest) {
    for (int m = 0; m < static_cast<int>(view.extent(0)); ++m)
      for (int i = part.first_row; i < part.last_row; ++i) {
        const Real* const row = &view(m, i, 0);
        Bits above = 0;
        for (int j = part.first_column; j < part.last_column; ++j) above |= Bits(ordered(row[j]) > largest);
        if (above != 0) return false;
      }
    return true;
  }

  Grid grid_;
  NodeBox box_;  // of the last launch: all rest outside
  Bits largest_V_, largest_Ta_;
};

}  // namespace myowave::tissue
