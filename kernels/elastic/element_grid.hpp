// The regular mesh of square bilinear elements in the undeformed sheet.
#pragma once

#include <Kokkos_Macros.hpp>

namespace myowave::elastic {

// Element (I, J), I along X2, J along X1; its nodes in the order (0,0), (1,0), (0,1), (1,1) of
// (xi_1, xi_2). Node (I, J) of the mesh lies at X1 = J h, X2 = I h.
struct ElementGrid {
  int rows = 0;     // elements along X2
  int columns = 0;  // elements along X1
  double h = 0;     // edge length, length units

  KOKKOS_FUNCTION constexpr int elements() const { return rows * columns; }
  KOKKOS_FUNCTION constexpr int nodes() const { return (rows + 1) * (columns + 1); }
  KOKKOS_FUNCTION constexpr int element(int I, int J) const { return I * columns + J; }
  KOKKOS_FUNCTION constexpr int node(int I, int J) const { return I * (columns + 1) + J; }
  // Mesh node of corner c = 0..3 of element e = I columns + J.
  KOKKOS_FUNCTION constexpr int corner(int e, int c) const {
    return node(e / columns + c / 2, e % columns + c % 2);
  }
};

}  // namespace myowave::elastic
