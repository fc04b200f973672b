// The diffusion term of Eq 22a, (1/sqrt C) (sqrt C C^-1_ML V_,L)_,M, in the three forms that a scene
// can ask for. Each form has
//   row(rows, m, i, origin)  of row i, r(j - 1, j, j + 1), with columns counted from `origin`: what a
//                            SIMD loop needs; r.prefetch(j)
//   at(V, m, i, j)           the same at any node, boundaries included; V of shape (members, rows, columns)
//   mirrored_edges           whether row() holds at the edges too, on mirrored neighbours
//   mirrors                  whether they count there: in a network of edges those outside weigh nothing, and
//                            what lies at their ends need only be finite
//   metric_rows(...)         row() for a team that goes up the rows; it copies its weights to
//                            scratch_entries(slots, pitch) of scratch memory; its rows_in_memory(i, rows) are
//                            those that row i takes from metric_arrays arrays
#pragma once

#include "kernels/base/row_loop.hpp"
#include "kernels/tissue/metric.hpp"

namespace myowave::tissue {

// Entries of an array of scratch rows `pitch` apart; a line more, so that arrays do not fall on one another
// in a cache.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION constexpr int array_entries(int rows, int pitch) {
  return rows * pitch + detail::line_of<Real>;
}

// The place of row i among `slots`, a power of two. Steps one after another take rows from above downwards,
// which lie upwards here: a processor fetches ahead what comes next.
KOKKOS_FORCEINLINE_FUNCTION constexpr int slot_of(int i, int slots) { return ~i & (slots - 1); }

// A number that the compiler knows.
template <int number>
struct Constant {
  KOKKOS_FUNCTION constexpr operator int() const { return number; }
};

// V in three neighbouring rows, all three from the same column on.
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

// Weights of the edge network, of a row and the one below it, all from the same column on. Five points have
// no antidiagonals of their own.
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

// The weights of a few neighbouring rows of a tile in scratch rows, one array for each kind.
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
    // Of five points its place is taken by one that is there, and not looked at.
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

// `expanded`: Eq 24 as printed, g^ML V_,ML - b^N V_,N with central differences. No flux by ghosts:
// V_,1 = -(g12/g11) V_,2 on the left and right edges, V_,2 = -(g12/g22) V_,1 on the others, both
// zero at the corners.
template <class Real, class MemorySpace>
struct ExpandedDiffusion {
  using Scalar = Real;
  using Space = MemorySpace;
  using ConstView = EnsembleField<const Real, MemorySpace>;
  static constexpr const char* name = "expanded";
  static constexpr bool mirrored_edges = false;

  Grid grid;
  ExpandedMetric<Real, MemorySpace> metric;
  Real half_inverse_dx = 0;
  Real inverse_dx2 = 0;

  ExpandedDiffusion() = default;
  ExpandedDiffusion(const Grid& g, const ExpandedMetric<Real, MemorySpace>& coefficients)
      : grid(g),
        metric(coefficients),
        half_inverse_dx(Real(0.5 / g.dx)),
        inverse_dx2(Real(1 / (g.dx * g.dx))) {}

  struct Row {
    StencilRows<Real> rows;
    const Real* KOKKOS_RESTRICT g11;
    const Real* KOKKOS_RESTRICT g12;
    const Real* KOKKOS_RESTRICT g22;
    const Real* KOKKOS_RESTRICT b1;
    const Real* KOKKOS_RESTRICT b2;
    Real half_inverse_dx;
    Real inverse_dx2;
    KOKKOS_FORCEINLINE_FUNCTION Real operator()(int west, int j, int east) const {
      const auto& [below, here, above] = rows;
      const Real V_11 = inverse_dx2 * (here[east] - Real(2) * here[j] + here[west]);
      const Real V_22 = inverse_dx2 * (above[j] - Real(2) * here[j] + below[j]);
      const Real V_12 = Real(0.25) * inverse_dx2 * (above[east] - above[west] - below[east] + below[west]);
      const Real V_1 = half_inverse_dx * (here[east] - here[west]);
      const Real V_2 = half_inverse_dx * (above[j] - below[j]);
      return g11[j] * V_11 + Real(2) * g12[j] * V_12 + g22[j] * V_22 - b1[j] * V_1 - b2[j] * V_2;
    }
    KOKKOS_FORCEINLINE_FUNCTION void prefetch(int j) const {
      prefetch_to_read(rows.above + j);
      prefetch_to_read(g11 + j);
      prefetch_to_read(g12 + j);
      prefetch_to_read(g22 + j);
      prefetch_to_read(b1 + j);
      prefetch_to_read(b2 + j);
    }
  };

  KOKKOS_FORCEINLINE_FUNCTION Row row(const StencilRows<Real>& V, int m, int i, int origin) const {
    return {V,
            &metric.g11(m, i, origin),
            &metric.g12(m, i, origin),
            &metric.g22(m, i, origin),
            &metric.b1(m, i, origin),
            &metric.b2(m, i, origin),
            half_inverse_dx,
            inverse_dx2};
  }

  KOKKOS_FUNCTION Real at(const ConstView& V, int m, int i, int j) const {
    const bool side = j == 0 || j == grid.columns - 1;
    const bool end = i == 0 || i == grid.rows - 1;
    if (!side && !end) return row(rows_of(V, grid, m, i), m, i, 0)(j - 1, j, j + 1);

    const Real V_1 = slope_1(V, m, i, j), V_2 = slope_2(V, m, i, j);
    const Real V_11 = side ? second_at_edge(V(m, i, j), V(m, i, j == 0 ? 1 : j - 1), j == 0 ? V_1 : -V_1)
                           : inverse_dx2 * (V(m, i, j + 1) - Real(2) * V(m, i, j) + V(m, i, j - 1));
    const Real V_22 = end ? second_at_edge(V(m, i, j), V(m, i == 0 ? 1 : i - 1, j), i == 0 ? V_2 : -V_2)
                          : inverse_dx2 * (V(m, i + 1, j) - Real(2) * V(m, i, j) + V(m, i - 1, j));
    Real V_12 = 0;  // at a corner
    if (side && !end) V_12 = half_inverse_dx * (slope_1(V, m, i + 1, j) - slope_1(V, m, i - 1, j));
    if (end && !side) V_12 = half_inverse_dx * (slope_2(V, m, i, j + 1) - slope_2(V, m, i, j - 1));
    return metric.g11(m, i, j) * V_11 + Real(2) * metric.g12(m, i, j) * V_12 + metric.g22(m, i, j) * V_22 -
           metric.b1(m, i, j) * V_1 - metric.b2(m, i, j) * V_2;
  }

 private:
  // Second derivative across an edge from the neighbour inside and the slope that no flux implies
  // (`inward`: towards the neighbour): the ghost is neighbour - 2 dx inward.
  KOKKOS_FUNCTION Real second_at_edge(Real here, Real inside, Real inward) const {
    return inverse_dx2 * Real(2) * (inside - here) - Real(4) * half_inverse_dx * inward;
  }

  KOKKOS_FUNCTION Real slope_1(const ConstView& V, int m, int i, int j) const {
    const bool side = j == 0 || j == grid.columns - 1;
    if (!side) return half_inverse_dx * (V(m, i, j + 1) - V(m, i, j - 1));
    if (i == 0 || i == grid.rows - 1) return 0;
    const Real V_2 = half_inverse_dx * (V(m, i + 1, j) - V(m, i - 1, j));
    return -metric.g12(m, i, j) / metric.g11(m, i, j) * V_2;
  }

  KOKKOS_FUNCTION Real slope_2(const ConstView& V, int m, int i, int j) const {
    const bool end = i == 0 || i == grid.rows - 1;
    if (!end) return half_inverse_dx * (V(m, i + 1, j) - V(m, i - 1, j));
    if (j == 0 || j == grid.columns - 1) return 0;
    const Real V_1 = half_inverse_dx * (V(m, i, j + 1) - V(m, i, j - 1));
    return -metric.g12(m, i, j) / metric.g22(m, i, j) * V_1;
  }
};

}  // namespace myowave::tissue
