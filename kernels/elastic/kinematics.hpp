// Kinematics of one bilinear element on the undeformed square [0, h]^2 (Nash & Panfilov 2004, Eqs 5-8).
//
//   x(xi) = sum_c Psi_c(xi) x_c,   X = h xi,   F_iM = dx_i/dX_M,   J = det F
//
// Corner c = 2 c2 + c1 has Psi_c = (c1 ? xi_1 : 1 - xi_1) (c2 ? xi_2 : 1 - xi_2).
// Quadrature: 2 x 2 Gauss points q = 2 q2 + q1, weight h^2/4 each.
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/base/tensor2.hpp"
#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"

namespace myowave::elastic {

inline constexpr int corners = 4;
inline constexpr int gauss_points = 4;
inline constexpr int element_dofs = 2 * corners;  // dof 2 c + i: component i of corner c

// Positions of the four corners, length units.
struct ElementNodes {
  double x[corners][2];
};

template <class NodesView>
KOKKOS_FORCEINLINE_FUNCTION ElementNodes element_nodes(const ElementGrid& grid, const NodesView& nodes, int I,
                                                       int J) {
  const int n = grid.node(I, J), m = grid.node(I + 1, J);
  return {{{nodes(n, 0), nodes(n, 1)},
           {nodes(n + 1, 0), nodes(n + 1, 1)},
           {nodes(m, 0), nodes(m, 1)},
           {nodes(m + 1, 0), nodes(m + 1, 1)}}};
}

template <class NodesView>
KOKKOS_INLINE_FUNCTION ElementNodes element_nodes(const ElementGrid& grid, const NodesView& nodes, int e) {
  return element_nodes(grid, nodes, e / grid.columns, e % grid.columns);
}

// Coordinate of Gauss point k = 0, 1 of the two-point rule on [0, 1]: 1/2 -+ 1/(2 sqrt 3).
KOKKOS_INLINE_FUNCTION constexpr double gauss_coordinate(int k) {
  return k == 0 ? 0.21132486540518711775 : 0.78867513459481288225;
}

// dPsi_c/dX_1 and dPsi_c/dX_2 at xi.
struct ShapeGradient {
  double d1, d2;
};

KOKKOS_INLINE_FUNCTION constexpr ShapeGradient shape_gradient(int c, double xi_1, double xi_2, double h) {
  const double along_1 = c % 2 == 1 ? xi_1 : 1 - xi_1;
  const double along_2 = c / 2 == 1 ? xi_2 : 1 - xi_2;
  return {(c % 2 == 1 ? along_2 : -along_2) / h, (c / 2 == 1 ? along_1 : -along_1) / h};
}

// F at xi, from differences along the edges, so that a translation of the element does not change it.
KOKKOS_FORCEINLINE_FUNCTION Mat2 deformation_gradient(const ElementNodes& element, double xi_1, double xi_2,
                                                      double h) {
  const auto& x = element.x;
  const double a1 = (1 - xi_2) / h, b1 = xi_2 / h;  // weights of the edges 0-1 and 2-3
  const double a2 = (1 - xi_1) / h, b2 = xi_1 / h;  // weights of the edges 0-2 and 1-3
  return {a1 * (x[1][0] - x[0][0]) + b1 * (x[3][0] - x[2][0]),
          a2 * (x[2][0] - x[0][0]) + b2 * (x[3][0] - x[1][0]),
          a1 * (x[1][1] - x[0][1]) + b1 * (x[3][1] - x[2][1]),
          a2 * (x[2][1] - x[0][1]) + b2 * (x[3][1] - x[1][1])};
}

// F at Gauss point q.
KOKKOS_FORCEINLINE_FUNCTION Mat2 gauss_deformation_gradient(const ElementNodes& element, int q, double h) {
  return deformation_gradient(element, gauss_coordinate(q % 2), gauss_coordinate(q / 2), h);
}

// Smallest J of the element. J is linear in xi on a bilinear element, so the smallest is at a corner. A check
// at the Gauss points alone would miss an inverted corner.
KOKKOS_FORCEINLINE_FUNCTION double min_corner_J(const ElementNodes& element, double h) {
  const double J_0 = determinant(deformation_gradient(element, 0, 0, h)),
               J_1 = determinant(deformation_gradient(element, 1, 0, h)),
               J_2 = determinant(deformation_gradient(element, 0, 1, h)),
               J_3 = determinant(deformation_gradient(element, 1, 1, h));
  return Kokkos::min(Kokkos::min(J_0, J_1), Kokkos::min(J_2, J_3));
}

}  // namespace myowave::elastic
