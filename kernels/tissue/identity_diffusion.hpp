// Diffusion on the undeformed sheet (see diffusion.hpp): the Laplacian of five or nine points.
#pragma once

#include "kernels/tissue/metric.hpp"
#include "kernels/tissue/stencil_rows.hpp"

namespace myowave::tissue {

// F = I: the Laplacian with mirrored edges.
template <class Real, class MemorySpace, Stencil stencil = Stencil::five_point>
struct IdentityDiffusion {
  using Scalar = Real;
  using Space = MemorySpace;
  using ConstView = EnsembleField<const Real, MemorySpace>;
  static constexpr const char* name = stencil == Stencil::nine_point ? "identity_nine_point" : "identity";
  static constexpr bool mirrored_edges = true, mirrors = true;

  Grid grid;
  Real inverse_dx2 = 0;

  IdentityDiffusion() = default;
  explicit IdentityDiffusion(const Grid& g) : grid(g), inverse_dx2(Real(1 / (g.dx * g.dx))) {}

  struct Row {
    StencilRows<Real> V;
    Real inverse_dx2;
    KOKKOS_FORCEINLINE_FUNCTION Real operator()(int west, int j, int east) const {
      const Real straight = (V.here[west] + V.here[east]) + (V.below[j] + V.above[j]);
      if constexpr (stencil == Stencil::five_point) return inverse_dx2 * (straight - Real(4) * V.here[j]);
      const Real oblique = (V.below[west] + V.above[east]) + (V.below[east] + V.above[west]);
      return inverse_dx2 * Real(1.0 / 6) * ((Real(4) * straight + oblique) - Real(20) * V.here[j]);
    }
    KOKKOS_FORCEINLINE_FUNCTION void prefetch(int j) const { prefetch_to_read(V.above + j); }
  };

  struct RowsOfTile {
    Real inverse_dx2;
    KOKKOS_FORCEINLINE_FUNCTION void rows_in_memory(int, const Real**) const {}
    KOKKOS_FORCEINLINE_FUNCTION void begin(int) const {}
    KOKKOS_FORCEINLINE_FUNCTION void prepare(int) const {}
    KOKKOS_FORCEINLINE_FUNCTION Row row(const StencilRows<Real>& V, int) const { return {V, inverse_dx2}; }
  };
  static constexpr int metric_arrays = 0;
  KOKKOS_FUNCTION static constexpr int scratch_entries(int, int) { return 0; }
  template <class Columns, class Pitch>
  KOKKOS_FORCEINLINE_FUNCTION RowsOfTile metric_rows(const Columns&, int, int, int, Real*, int, Pitch) const {
    return {inverse_dx2};
  }

  KOKKOS_FORCEINLINE_FUNCTION Row row(const StencilRows<Real>& V, int, int, int) const {
    return {V, inverse_dx2};
  }

  KOKKOS_FORCEINLINE_FUNCTION Real at(const ConstView& V, int m, int i, int j) const {
    return row(rows_of(V, grid, m, i), m, i, 0)(mirrored(j - 1, grid.columns), j,
                                                mirrored(j + 1, grid.columns));
  }
};

}  // namespace myowave::tissue
