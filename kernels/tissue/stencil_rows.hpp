// Rows of V that a stencil reads, in memory or in the scratch memory of a tile.
#pragma once

#include "kernels/base/row_loop.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::tissue {

// Entries of an array of scratch rows `pitch` apart; a line more, so that arrays do not fall on one another
// in a cache.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION constexpr int array_entries(int rows, int pitch) {
  return rows * pitch + detail::line_of<Real>;
}

// The place of row i among `slots`, a power of two. Steps one after another take rows from above downwards,
// which lie upwards here: a processor fetches ahead what comes next.
KOKKOS_FORCEINLINE_FUNCTION constexpr int slot_of(int i, int slots) { return ~i & (slots - 1); }

// A number that the compiler knows.
template <int number>
struct Constant {
  KOKKOS_FUNCTION constexpr operator int() const { return number; }
};

// V in three neighbouring rows, all three from the same column on.
template <class Real>
struct StencilRows {
  const Real* KOKKOS_RESTRICT below;
  const Real* KOKKOS_RESTRICT here;
  const Real* KOKKOS_RESTRICT above;
};

// Row i of a field of the sheet with its neighbours, mirrored at the first and the last row.
template <class View>
KOKKOS_FORCEINLINE_FUNCTION auto rows_of(const View& V, const Grid& grid, int m, int i, int origin = 0) {
  return StencilRows<typename View::non_const_value_type>{
      &V(m, mirrored(i - 1, grid.rows), origin), &V(m, i, origin), &V(m, mirrored(i + 1, grid.rows), origin)};
}

}  // namespace myowave::tissue
