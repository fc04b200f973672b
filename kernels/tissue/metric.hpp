// What the tissue kernels read of a deformed sheet. kernels/transfer writes it from the element
// nodes; nothing here knows of elements.
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::tissue {

// Weights of the edge network that the cell energies of the `conservative` form make (see
// diffusion.hpp). All Views have shape (members, rows + 1, columns + 1): the entry of node or cell
// (i, j) stands at (i + 1, j + 1), and entries outside the sheet are zero, so that no-flux edges
// need no branch.
template <class Real, class MemorySpace>
struct ConservativeMetric {
  using View = EnsembleField<Real, MemorySpace>;
  View east;          // node (i,j) - (i,j+1): half the sum of G11 of the cells above and below
  View north;         // node (i,j) - (i+1,j): half the sum of G22 of the cells left and right
  View diagonal;      // cell (i,j): G12 / 2, + for (i,j)-(i+1,j+1), - for (i,j+1)-(i+1,j)
  View inverse_mass;  // node: 1 / (M_i dx^2), M_i = sum over adjacent cells of sqrt C / 4

  ConservativeMetric() = default;
  ConservativeMetric(int members, const Grid& grid)
      : east("myowave::tissue::metric_east", members, grid.rows + 1, grid.columns + 1),
        north("myowave::tissue::metric_north", members, grid.rows + 1, grid.columns + 1),
        diagonal("myowave::tissue::metric_diagonal", members, grid.rows + 1, grid.columns + 1),
        inverse_mass("myowave::tissue::metric_inverse_mass", members, grid.rows + 1, grid.columns + 1) {}
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
