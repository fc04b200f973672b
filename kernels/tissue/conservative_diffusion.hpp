// Diffusion in conservative form on the deformed metric (see diffusion.hpp): a network of edges.
#pragma once

#include "kernels/tissue/metric.hpp"
#include "kernels/tissue/stencil_rows.hpp"

namespace myowave::tissue {

// Weights of the edge network of a row and the one below it; the pointers are to the same column. With five
// points an antidiagonal has minus the weight of its cell's diagonal.
template <class Real, Stencil stencil = Stencil::five_point>
struct EdgeWeights {
  const Real* KOKKOS_RESTRICT east_;
  const Real* KOKKOS_RESTRICT north_;
  const Real* KOKKOS_RESTRICT north_below_;
  const Real* KOKKOS_RESTRICT diagonal_;
  const Real* KOKKOS_RESTRICT diagonal_below_;
  const Real* KOKKOS_RESTRICT inverse_mass_;
  const Real* KOKKOS_RESTRICT antidiagonal_;
  const Real* KOKKOS_RESTRICT antidiagonal_below_;
  KOKKOS_FORCEINLINE_FUNCTION Real east(int j) const { return east_[j]; }
  KOKKOS_FORCEINLINE_FUNCTION Real north(int j) const { return north_[j]; }
  KOKKOS_FORCEINLINE_FUNCTION Real north_below(int j) const { return north_below_[j]; }
  KOKKOS_FORCEINLINE_FUNCTION Real diagonal(int j) const { return diagonal_[j]; }
  KOKKOS_FORCEINLINE_FUNCTION Real diagonal_below(int j) const { return diagonal_below_[j]; }
  KOKKOS_FORCEINLINE_FUNCTION Real antidiagonal(int j) const {
    return stencil == Stencil::nine_point ? antidiagonal_[j] : -diagonal(j);
  }
  KOKKOS_FORCEINLINE_FUNCTION Real antidiagonal_below(int j) const {
    return stencil == Stencil::nine_point ? antidiagonal_below_[j] : -diagonal_below(j);
  }
  KOKKOS_FORCEINLINE_FUNCTION Real inverse_mass(int j) const { return inverse_mass_[j]; }
  KOKKOS_FORCEINLINE_FUNCTION void prefetch(int j) const {
    prefetch_to_read(east_ + j);
    prefetch_to_read(north_ + j);
    prefetch_to_read(diagonal_ + j);
    if constexpr (stencil == Stencil::nine_point) prefetch_to_read(antidiagonal_ + j);
    prefetch_to_read(inverse_mass_ + j);
  }
};

// The weights of a few neighbouring rows of a tile in scratch memory, one array for each kind.
template <class Real, class Pitch, Stencil stencil = Stencil::five_point>
struct WeightRows {
  Real* begin;  // the tile's first column, aligned
  int slots;
  Pitch pitch;

  static constexpr int kinds = stencil == Stencil::nine_point ? 5 : 4;
  KOKKOS_FUNCTION static constexpr int entries(int slots, int pitch) {
    return kinds * array_entries<Real>(slots, pitch);
  }
  KOKKOS_FORCEINLINE_FUNCTION Real* east(int i) const { return row(0, i); }
  KOKKOS_FORCEINLINE_FUNCTION Real* north(int i) const { return row(1, i); }
  KOKKOS_FORCEINLINE_FUNCTION Real* diagonal(int i) const { return row(2, i); }
  KOKKOS_FORCEINLINE_FUNCTION Real* inverse_mass(int i) const { return row(3, i); }
  KOKKOS_FORCEINLINE_FUNCTION Real* antidiagonal(int i) const {
    return row(stencil == Stencil::nine_point ? 4 : 2, i);
  }
  KOKKOS_FORCEINLINE_FUNCTION EdgeWeights<Real, stencil> of_row(int i) const {
    return {east(i),         north(i),        north(i - 1),    diagonal(i),
            diagonal(i - 1), inverse_mass(i), antidiagonal(i), antidiagonal(i - 1)};
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION Real* row(int kind, int i) const {
    return begin + kind * array_entries<Real>(slots, pitch) + slot_of(i, slots) * pitch;
  }
};

// `conservative`: the gradient of the cell energies
//   E = 1/4 { G11 [(V10-V00)^2 + (V11-V01)^2] + G22 [(V01-V00)^2 + (V11-V10)^2]
//             + G12 [(V11-V00)^2 - (V10-V01)^2] },   G = sqrt C C^-1 at the cell centre,
// (the product of mean slopes written as a difference of squares), less twist_part(stencil), which is a
// network of edges:
//   V_t = sum_edges w (V_neighbour - V_i) / (M_i dx^2).
template <class Real, class MemorySpace, Stencil stencil = Stencil::five_point>
struct ConservativeDiffusion {
  using Scalar = Real;
  using Space = MemorySpace;
  using ConstView = EnsembleField<const Real, MemorySpace>;
  static constexpr const char* name =
      stencil == Stencil::nine_point ? "conservative_nine_point" : "conservative";
  static constexpr bool mirrored_edges = true, mirrors = false;

  Grid grid;
  ConservativeMetric<Real, MemorySpace, stencil> metric;

  ConservativeDiffusion() = default;
  ConservativeDiffusion(const Grid& g, const ConservativeMetric<Real, MemorySpace, stencil>& coefficients)
      : grid(g), metric(coefficients) {}

  // The diffusion along a row from the weights of its edges.
  struct Row {
    StencilRows<Real> rows;
    EdgeWeights<Real, stencil> w;
    KOKKOS_FORCEINLINE_FUNCTION Real operator()(int west, int j, int east) const {
      const auto& [below, here, above] = rows;
      const Real V = here[j];
      const Real straight = w.east(j) * (here[east] - V) + w.east(j - 1) * (here[west] - V) +
                            w.north(j) * (above[j] - V) + w.north_below(j) * (below[j] - V);
      const Real oblique = w.diagonal(j) * (above[east] - V) + w.diagonal_below(j - 1) * (below[west] - V) +
                           w.antidiagonal(j - 1) * (above[west] - V) +
                           w.antidiagonal_below(j) * (below[east] - V);
      return w.inverse_mass(j) * (straight + oblique);
    }
    KOKKOS_FORCEINLINE_FUNCTION void prefetch(int j) const {
      prefetch_to_read(rows.above + j);
      w.prefetch(j);
    }
  };

  template <class Columns, class Pitch>
  struct RowsOfTile {
    ConservativeMetric<Real, MemorySpace, stencil> metric;
    Columns columns;
    int member, origin, inside;
    WeightRows<Real, Pitch, stencil> weights;

    KOKKOS_FORCEINLINE_FUNCTION void rows_in_memory(int i, const Real** rows) const {
      rows[0] = &metric.east(member, i + 1, origin + 1);
      rows[1] = &metric.north(member, i + 1, origin + 1);
      rows[2] = &metric.diagonal(member, i + 1, origin + 1);
      rows[3] = &metric.inverse_mass(member, i + 1, origin + 1);
      if constexpr (stencil == Stencil::nine_point) rows[4] = &metric.antidiagonal(member, i + 1, origin + 1);
    }
    KOKKOS_FORCEINLINE_FUNCTION void begin(int i) const { prepare(i - 1); }
    KOKKOS_FORCEINLINE_FUNCTION void prepare(int i) const {
      copy(metric.east, weights.east(i), i);
      copy(metric.north, weights.north(i), i);
      copy(metric.diagonal, weights.diagonal(i), i);
      if constexpr (stencil == Stencil::nine_point) copy(metric.antidiagonal, weights.antidiagonal(i), i);
      copy(metric.inverse_mass, weights.inverse_mass(i), i);
    }
    KOKKOS_FORCEINLINE_FUNCTION Row row(const StencilRows<Real>& V, int i) const {
      return {V, weights.of_row(i)};
    }

   private:
    KOKKOS_FORCEINLINE_FUNCTION void copy(const EnsembleField<Real, MemorySpace>& view, Real* to,
                                          int i) const {
      const Real* const from = &view(member, i + 1, origin + 1);
      columns.each_again(0, inside, [=](int j) { to[j] = from[j]; });
    }
  };
  static constexpr int metric_arrays = stencil == Stencil::nine_point ? 5 : 4;
  KOKKOS_FUNCTION static constexpr int scratch_entries(int slots, int pitch) {
    return WeightRows<Real, int, stencil>::entries(slots, pitch);
  }
  template <class Columns, class Pitch>
  KOKKOS_FORCEINLINE_FUNCTION RowsOfTile<Columns, Pitch> metric_rows(const Columns& columns, int m,
                                                                     int origin, int width, Real* scratch,
                                                                     int slots, Pitch pitch) const {
    return {metric, columns, m, origin, Kokkos::min(width, grid.columns - origin), {scratch, slots, pitch}};
  }

  // Rows in memory are shifted by one (see ConservativeMetric).
  KOKKOS_FORCEINLINE_FUNCTION Row row(const StencilRows<Real>& V, int m, int i, int origin) const {
    // With five points the pointer is not used; it points to the diagonals, which exist.
    const auto& antidiagonal = stencil == Stencil::nine_point ? metric.antidiagonal : metric.diagonal;
    const int j = origin + 1;
    return {V,
            {&metric.east(m, i + 1, j), &metric.north(m, i + 1, j), &metric.north(m, i, j),
             &metric.diagonal(m, i + 1, j), &metric.diagonal(m, i, j), &metric.inverse_mass(m, i + 1, j),
             &antidiagonal(m, i + 1, j), &antidiagonal(m, i, j)}};
  }

  KOKKOS_FORCEINLINE_FUNCTION Real at(const ConstView& V, int m, int i, int j) const {
    return row(rows_of(V, grid, m, i), m, i, 0)(mirrored(j - 1, grid.columns), j,
                                                mirrored(j + 1, grid.columns));
  }
};

}  // namespace myowave::tissue
