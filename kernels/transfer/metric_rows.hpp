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
  static constexpr bool mirrors = false;

  tissue::Grid grid;
  elastic::ElementGrid elements;
  int cells_per_element = 1;
  Nodes<MemorySpace> nodes;

  template <class Columns, class Pitch>
  struct RowsOfTile {
    using Weights = tissue::WeightRows<Real, Pitch>;
    const DeformedDiffusion& form;
    Columns columns;
    int origin, inside;
    Pitch pitch;
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
      // Beyond the last column the scratch memory stays zero.
      const auto zero = [&](Real* row) { columns.each(0, inside, [=](int j) { row[j] = 0; }); };
      zero(G11()), zero(J());
      if (i == 0) {
        zero(weights.north(-1)), zero(weights.diagonal(-1));
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
      return typename Form::Row{V, weights.of_row(i)};
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
      const Pitch apart = pitch;
      columns.each(0, cells_inside(), [=](int j) {
        // exact for sheets of up to 2^20 columns, and without a division of integers
        const int J = static_cast<int>((static_cast<float>(first + j) + 0.5f) * per_element);
        const Real xi_1 = (static_cast<Real>(first + j - J * cells) + Real(0.5)) / cells;
        const int low = mesh.node(I, J), high = mesh.node(I + 1, J);
        for (int k = 0; k < 2; ++k) {
          const double x00 = x(low, k), x10 = x(low + 1, k), x01 = x(high, k), x11 = x(high + 1, k);
          const Real bottom = Real((x10 - x00) * inverse_h), top = Real((x11 - x01) * inverse_h);
          const Real left = Real((x01 - x00) * inverse_h), right = Real((x11 - x10) * inverse_h);
          to[j + k * apart] = bottom;
          to[j + (2 + k) * apart] = top - bottom;
          to[j + (4 + k) * apart] = left + xi_1 * (right - left);
        }
      });
      columns.wait();
    }

    KOKKOS_FORCEINLINE_FUNCTION void cell_row(int i, Real xi_2) const {
      const Real* const edge = edges();
      Real* const sums = rest;
      Real* const east = weights.east(i);
      Real* const diagonal = weights.diagonal(i);
      const Pitch apart = pitch;
      columns.each(0, cells_inside(), [=](int j) {
        const Real a1 = edge[j] + xi_2 * edge[j + 2 * apart],
                   a2 = edge[j + apart] + xi_2 * edge[j + 3 * apart];
        const Real b1 = edge[j + 4 * apart], b2 = edge[j + 5 * apart];
        const Real det = a1 * b2 - a2 * b1;
        const Real inverse = Real(1) / det;
        const Real G11_here = (b1 * b1 + b2 * b2) * inverse;
        east[j] = Real(0.5) * (sums[j] + G11_here);
        diagonal[j] = Real(-0.5) * (a1 * b1 + a2 * b2) * inverse;
        sums[j] = G11_here;                               // G11
        sums[j + apart] = (a1 * a1 + a2 * a2) * inverse;  // G22
        sums[j + 3 * apart] = sums[j + 2 * apart] + det;  // J_sum
        sums[j + 2 * apart] = det;                        // J
      });
    }

    // Above the last row.
    KOKKOS_FORCEINLINE_FUNCTION void no_cell_row(int i) const {
      Real* const sums = rest;
      Real* const east = weights.east(i);
      Real* const diagonal = weights.diagonal(i);
      const Pitch apart = pitch;
      columns.each(0, cells_inside(), [=](int j) {
        east[j] = Real(0.5) * sums[j];
        diagonal[j] = 0;
        sums[j + apart] = 0;
        sums[j + 3 * apart] = sums[j + 2 * apart];
      });
    }
  };

  static constexpr int metric_arrays = 0;
  KOKKOS_FUNCTION static constexpr int scratch_entries(int slots, int pitch) {
    return tissue::WeightRows<Real, int>::entries(slots, pitch) + 10 * pitch;
  }
  template <class Columns, class Pitch>
  KOKKOS_FORCEINLINE_FUNCTION RowsOfTile<Columns, Pitch> metric_rows(const Columns& columns, int /*m*/,
                                                                     int origin, int width, Real* scratch,
                                                                     int slots, Pitch pitch) const {
    return {*this,
            columns,
            origin,
            Kokkos::min(width, grid.columns - origin),
            pitch,
            {scratch, slots, pitch},
            scratch + tissue::WeightRows<Real, int>::entries(slots, pitch)};
  }
};

}  // namespace myowave::transfer
