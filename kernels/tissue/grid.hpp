// The finite-difference grid in material coordinates: node (i, j) at X1 = j dx, X2 = i dx.
#pragma once

#include <Kokkos_Macros.hpp>

namespace myowave::tissue {

struct Grid {
  int rows = 0;     // nodes along X2, >= 2
  int columns = 0;  // nodes along X1, >= 2
  double dx = 0.6;  // length units
};

// No flux by mirroring about the boundary node: V(-1) = V(1), V(n) = V(n-2).
KOKKOS_FORCEINLINE_FUNCTION constexpr int mirrored(int j, int n) {
  return j < 0 ? -j : (j < n ? j : 2 * (n - 1) - j);
}

// How many tiles of `owned` nodes cover a line of `nodes`.
constexpr int tiles_of(int nodes, int owned) { return (nodes + owned - 1) / owned; }

}  // namespace myowave::tissue
