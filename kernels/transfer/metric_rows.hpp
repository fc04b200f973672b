// The `conservative` form with its metric computed from the element nodes while a team goes up the rows,
// instead of loaded from memory (see kernels/tissue/tiled_step.hpp and deformation_to_grid.hpp).
//
//   view    shape        unit     access
//   nodes   (nodes, 2)   length   read, the same for all members
//
// At height xi_2 of an element, with the differences of its corners over h,
//   x_,1 = e + xi_2 d,  constant along the row;  x_,2 = q + xi_1 s;  J = det(x_,1, x_,2),
//   G11 = x_,2 . x_,2 / J,   G22 = x_,1 . x_,1 / J,   G12 = -x_,1 . x_,2 / J.
// e, d and x_,2 of every column stay in scratch memory for the rows of an element.
#pragma once

#include "kernels/elastic/element_grid.hpp"
#include "kernels/tissue/diffusion.hpp"

namespace myowave::transfer {

template <class Real, class MemorySpace>
struct DeformedDiffusion {
  using Scalar = Real;
  static constexpr bool mirrors_ends = false;

  tissue::Grid grid;
  elastic::ElementGrid elements;
  int cells_per_element = 1;
  Nodes<MemorySpace> nodes;

  template <int pitch, class Columns>
  struct RowsOfTile {
    using Weights = tissue::WeightRows<Real, pitch>;
    const DeformedDiffusion& form;
    Columns columns;
    int origin, inside;
    Weights weights;
    Real* rest;  // ten rows more

    // Of the cells of the row below, and of this one: sums that the nodes between them need.
    KOKKOS_FORCEINLINE_FUNCTION Real* G11() const { return rest; }
    KOKKOS_FORCEINLINE_FUNCTION Real* G22() const { return rest + pitch; }
    KOKKOS_FORCEINLINE_FUNCTION Real* J() const { return rest + 2 * pitch; }
    KOKKOS_FORCEINLINE_FUNCTION Real* J_sum() const { return rest + 3 * pitch; }
    // Six numbers of the element of each cell: e, d and x_,2.
    KOKKOS_FORCEINLINE_FUNCTION Real* edges() const { return rest + 4 * pitch; }

    KOKKOS_FORCEINLINE_FUNCTION void rows_in_memory(int, const Real**) const {}
    KOKKOS_FORCEINLINE_FUNCTION void begin(int i) const {
      const auto zero = [&](Real* row, int first) {
        columns.each(first, inside, [=](int j) { row[j] = 0; });
      };
      zero(G11(), 0), zero(J(), 0);
      // Cells beyond the last column are never written.
      zero(G22(), cells_inside()), zero(J_sum(), cells_inside());
      for (int slot = 0; slot < weights.slots; ++slot)
        zero(weights.east(slot), cells_inside()), zero(weights.diagonal(slot), cells_inside());
      if (i == 0) {
        zero(weights.north(-1), 0), zero(weights.diagonal(-1), 0);
        return;
      }
      element_row((i - 1) / form.cells_per_element);
      prepare(i - 1);
    }

    // The weights of node row i from the cells of row i and, of the call before, of row i - 1.
    KOKKOS_FORCEINLINE_FUNCTION void prepare(int i) const {
      const int cells = form.cells_per_element, I = i / cells;
      if (i % cells == 0 && I < form.elements.rows) element_row(I);
      if (i < form.grid.rows - 1)
        cell_row(i, (i - I * cells + Real(0.5)) / cells);
      else
        no_cell_row(i);
      columns.wait();
      Real* const north = weights.north(i);
      Real* const inverse_mass = weights.inverse_mass(i);
      const Real* const G22_ = G22();
      const Real* const J_sum_ = J_sum();
      const Real four_over_dx2 = Real(4 / (form.grid.dx * form.grid.dx));
      columns.each(0, inside, [=](int j) {
        north[j] = Real(0.5) * (G22_[j - 1] + G22_[j]);
        inverse_mass[j] = four_over_dx2 / (J_sum_[j - 1] + J_sum_[j]);
      });
      columns.wait();
    }

    KOKKOS_FORCEINLINE_FUNCTION auto row(const tissue::StencilRows<Real>& V, int i) const {
      using Form = tissue::ConservativeDiffusion<Real, MemorySpace>;
      return typename Form::template RowOf<typename Weights::OfRow>{V, weights.of_row(i)};
    }

   private:
    // Cells of a row: those of the last node's column lie outside the sheet.
    KOKKOS_FORCEINLINE_FUNCTION int cells_inside() const {
      return Kokkos::min(inside, form.grid.columns - 1 - origin);
    }

    KOKKOS_FORCEINLINE_FUNCTION void element_row(int I) const {
      const auto mesh = form.elements;
      const auto x = form.nodes;
      const int first = origin;
      const float per_element = 1.0f / static_cast<float>(form.cells_per_element);
      const int cells = form.cells_per_element;
      const double inverse_h = 1 / mesh.h;
      Real* const to = edges();
      columns.each(0, cells_inside(), [=](int j) {
        // exact for sheets of up to 2^20 columns, and without a division of integers
        const int J = static_cast<int>((static_cast<float>(first + j) + 0.5f) * per_element);
        const Real xi_1 = (static_cast<Real>(first + j - J * cells) + Real(0.5)) / cells;
        const int low = mesh.node(I, J), high = mesh.node(I + 1, J);
        for (int k = 0; k < 2; ++k) {
          const double x00 = x(low, k), x10 = x(low + 1, k), x01 = x(high, k), x11 = x(high + 1, k);
          const Real bottom = Real((x10 - x00) * inverse_h), top = Real((x11 - x01) * inverse_h);
          const Real left = Real((x01 - x00) * inverse_h), right = Real((x11 - x10) * inverse_h);
          to[j + k * pitch] = bottom;
          to[j + (2 + k) * pitch] = top - bottom;
          to[j + (4 + k) * pitch] = left + xi_1 * (right - left);
        }
      });
      columns.wait();
    }

    KOKKOS_FORCEINLINE_FUNCTION void cell_row(int i, Real xi_2) const {
      const Real* const edge = edges();
      Real* const sums = rest;
      Real* const to = weights.east(i);
      columns.each(0, cells_inside(), [=](int j) {
        const Real a1 = edge[j] + xi_2 * edge[j + 2 * pitch],
                   a2 = edge[j + pitch] + xi_2 * edge[j + 3 * pitch];
        const Real b1 = edge[j + 4 * pitch], b2 = edge[j + 5 * pitch];
        const Real det = a1 * b2 - a2 * b1;
        const Real inverse = Real(1) / det;
        const Real G11_here = (b1 * b1 + b2 * b2) * inverse;
        to[j] = Real(0.5) * (sums[j] + G11_here);                        // east
        to[j + 2 * pitch] = Real(-0.5) * (a1 * b1 + a2 * b2) * inverse;  // diagonal
        sums[j] = G11_here;                                              // G11
        sums[j + pitch] = (a1 * a1 + a2 * a2) * inverse;                 // G22
        sums[j + 3 * pitch] = sums[j + 2 * pitch] + det;                 // J_sum
        sums[j + 2 * pitch] = det;                                       // J
      });
    }

    // Above the last row.
    KOKKOS_FORCEINLINE_FUNCTION void no_cell_row(int i) const {
      Real* const sums = rest;
      Real* const to = weights.east(i);
      columns.each(0, cells_inside(), [=](int j) {
        to[j] = Real(0.5) * sums[j];
        to[j + 2 * pitch] = 0;
        sums[j + pitch] = 0;
        sums[j + 3 * pitch] = sums[j + 2 * pitch];
      });
    }
  };

  static constexpr int metric_arrays = 0;
  template <int pitch>
  static constexpr int scratch_rows(int slots) {
    return tissue::WeightRows<Real, pitch>::rows(slots) + 10;
  }
  template <int pitch, class Columns>
  KOKKOS_FORCEINLINE_FUNCTION RowsOfTile<pitch, Columns> metric_rows(const Columns& columns, int /*m*/,
                                                                     int origin, int width, Real* scratch,
                                                                     int slots) const {
    return {*this,
            columns,
            origin,
            Kokkos::min(width, grid.columns - origin),
            {scratch, slots},
            scratch + tissue::WeightRows<Real, pitch>::rows(slots) * pitch};
  }
};

}  // namespace myowave::transfer
