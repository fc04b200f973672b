// Rows of V that a stencil reads, in memory or in the scratch memory of a tile.
#pragma once

#include "kernels/base/row_loop.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::tissue {

// Entries of an array of scratch rows `pitch` apart, and one line more, so that arrays do not map to the same
// cache sets.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION constexpr int array_entries(int rows, int pitch) {
  return rows * pitch + detail::line_of<Real>;
}

// The place of row i among `slots`, a power of two. Successive levels of a front use rows from above
// downwards; here these are at increasing addresses, which a processor prefetches.
KOKKOS_FORCEINLINE_FUNCTION constexpr int slot_of(int i, int slots) { return ~i & (slots - 1); }

// A compile-time number with the interface of an int.
template <int number>
struct Constant {
  KOKKOS_FUNCTION constexpr operator int() const { return number; }
};

// V in three neighbouring rows; the pointers are to the same column.
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
