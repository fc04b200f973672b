// What the tissue kernels read of a deformed sheet. kernels/transfer writes it from the element
// nodes; nothing here knows of elements.
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::tissue {

// The paper's, or an isotropic one, whose leading error is dx^2 / 12 laplacian^2 V in every direction.
enum class Stencil { five_point, nine_point };

// Of (G11 + G22) (V00 + V11 - V10 - V01)^2 / 2, what the nine-point stencil takes from a cell's energy.
constexpr double twist_part(Stencil stencil) { return stencil == Stencil::nine_point ? 1.0 / 12 : 0.0; }

// Weights of the edge network that the cell energies of the `conservative` form make (see
// diffusion.hpp). All Views have shape (members, rows + 1, columns + 1): the entry of node or cell
// (i, j) stands at (i + 1, j + 1), and entries outside the sheet are zero, so that no-flux edges
// need no branch.
//
// The nine-point stencil takes `twist` = (G11 + G22) / 12 of every cell from its sides to its diagonals.
template <class Real, class MemorySpace, Stencil stencil = Stencil::five_point>
struct ConservativeMetric {
  using View = EnsembleField<Real, MemorySpace>;
  View east;      // node (i,j) - (i,j+1): sum of G11 / 2 - twist of the cells above and below
  View north;     // node (i,j) - (i+1,j): sum of G22 / 2 - twist of the cells left and right
  View diagonal;  // cell (i,j), (i,j)-(i+1,j+1): twist + G12 / 2
  View
      antidiagonal;  // cell (i,j), (i,j+1)-(i+1,j): twist - G12 / 2; without twist empty, for it is -diagonal
  View inverse_mass;  // node: 1 / (M_i dx^2), M_i = sum over adjacent cells of sqrt C / 4

  ConservativeMetric() = default;
  ConservativeMetric(int members, const Grid& grid)
      : east("myowave::tissue::metric_east", members, grid.rows + 1, grid.columns + 1),
        north("myowave::tissue::metric_north", members, grid.rows + 1, grid.columns + 1),
        diagonal("myowave::tissue::metric_diagonal", members, grid.rows + 1, grid.columns + 1),
        inverse_mass("myowave::tissue::metric_inverse_mass", members, grid.rows + 1, grid.columns + 1) {
    if constexpr (stencil == Stencil::nine_point)
      antidiagonal = View("myowave::tissue::metric_antidiagonal", members, grid.rows + 1, grid.columns + 1);
  }
};

// Coefficients of the `expanded` form (Eq 24) at the nodes, shape (members, rows, columns).
template <class Real, class MemorySpace>
struct ExpandedMetric {
  using View = EnsembleField<Real, MemorySpace>;
  View g11, g12, g22;  // C^-1
  View b1, b2;         // g^ML Gamma^N_ML, N = 1, 2

  ExpandedMetric() = default;
  ExpandedMetric(int members, const Grid& grid)
      : g11("myowave::tissue::metric_g11", members, grid.rows, grid.columns),
        g12("myowave::tissue::metric_g12", members, grid.rows, grid.columns),
        g22("myowave::tissue::metric_g22", members, grid.rows, grid.columns),
        b1("myowave::tissue::metric_b1", members, grid.rows, grid.columns),
        b2("myowave::tissue::metric_b2", members, grid.rows, grid.columns) {}
};

}  // namespace myowave::tissue
