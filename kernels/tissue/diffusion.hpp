// The diffusion term of Eq 22a, (1/sqrt C) (sqrt C C^-1_ML V_,L)_,M, in the three forms that a scene
// can ask for. Each form has
//   row(V, m, i)   what the SIMD loop of monodomain_step needs of row i: r(j - 1, j, j + 1)
//   at(V, m, i, j) the same at any node, boundaries included
//   row_is_regular(i) whether row(i) holds for all columns but the first and the last
// and sets them from a View V of shape (members, rows, columns).
#pragma once

#include "kernels/tissue/metric.hpp"

namespace myowave::tissue {

// F = I: the 5-point Laplacian with mirrored edges.
template <class Real, class MemorySpace>
struct IdentityDiffusion {
  using Scalar = Real;
  using Space = MemorySpace;
  using ConstView = EnsembleField<const Real, MemorySpace>;
  static constexpr const char* name = "identity";

  Grid grid;
  Real inverse_dx2 = 0;

  IdentityDiffusion() = default;
  explicit IdentityDiffusion(const Grid& g) : grid(g), inverse_dx2(Real(1 / (g.dx * g.dx))) {}

  struct Row {
    const Real* KOKKOS_RESTRICT below;
    const Real* KOKKOS_RESTRICT here;
    const Real* KOKKOS_RESTRICT above;
    Real inverse_dx2;
    KOKKOS_FORCEINLINE_FUNCTION Real operator()(int west, int j, int east) const {
      return inverse_dx2 * ((here[west] + here[east]) + (below[j] + above[j]) - Real(4) * here[j]);
    }
  };

  KOKKOS_FORCEINLINE_FUNCTION bool row_is_regular(int) const { return true; }

  KOKKOS_FORCEINLINE_FUNCTION Row row(const ConstView& V, int m, int i) const {
    return {&V(m, mirrored(i - 1, grid.rows), 0), &V(m, i, 0), &V(m, mirrored(i + 1, grid.rows), 0),
            inverse_dx2};
  }

  KOKKOS_FORCEINLINE_FUNCTION Real at(const ConstView& V, int m, int i, int j) const {
    return row(V, m, i)(mirrored(j - 1, grid.columns), j, mirrored(j + 1, grid.columns));
  }
};

// `conservative`: the gradient of the cell energies
//   E = 1/4 { G11 [(V10-V00)^2 + (V11-V01)^2] + G22 [(V01-V00)^2 + (V11-V10)^2]
//             + G12 [(V11-V00)^2 - (V10-V01)^2] },   G = sqrt C C^-1 at the cell centre,
// (the product of mean slopes written as a difference of squares), which is a network of edges:
//   V_t = sum_edges w (V_neighbour - V_i) / (M_i dx^2).
template <class Real, class MemorySpace>
struct ConservativeDiffusion {
  using Scalar = Real;
  using Space = MemorySpace;
  using ConstView = EnsembleField<const Real, MemorySpace>;
  static constexpr const char* name = "conservative";

  Grid grid;
  ConservativeMetric<Real, MemorySpace> metric;

  ConservativeDiffusion() = default;
  ConservativeDiffusion(const Grid& g, const ConservativeMetric<Real, MemorySpace>& coefficients)
      : grid(g), metric(coefficients) {}

  // Weights are shifted by one (see ConservativeMetric): weight[j] is that of column j - 1.
  struct Row {
    const Real* KOKKOS_RESTRICT below;
    const Real* KOKKOS_RESTRICT here;
    const Real* KOKKOS_RESTRICT above;
    const Real* KOKKOS_RESTRICT w_east;
    const Real* KOKKOS_RESTRICT w_north;
    const Real* KOKKOS_RESTRICT w_north_below;
    const Real* KOKKOS_RESTRICT w_diagonal;
    const Real* KOKKOS_RESTRICT w_diagonal_below;
    const Real* KOKKOS_RESTRICT inverse_mass;
    KOKKOS_FORCEINLINE_FUNCTION Real operator()(int west, int j, int east) const {
      const Real V = here[j];
      const Real straight = w_east[j + 1] * (here[east] - V) + w_east[j] * (here[west] - V) +
                            w_north[j + 1] * (above[j] - V) + w_north_below[j + 1] * (below[j] - V);
      const Real oblique = w_diagonal[j + 1] * (above[east] - V) + w_diagonal_below[j] * (below[west] - V) -
                           w_diagonal[j] * (above[west] - V) - w_diagonal_below[j + 1] * (below[east] - V);
      return inverse_mass[j + 1] * (straight + oblique);
    }
  };

  KOKKOS_FORCEINLINE_FUNCTION bool row_is_regular(int) const { return true; }

  KOKKOS_FORCEINLINE_FUNCTION Row row(const ConstView& V, int m, int i) const {
    return {&V(m, mirrored(i - 1, grid.rows), 0), &V(m, i, 0),
            &V(m, mirrored(i + 1, grid.rows), 0), &metric.east(m, i + 1, 0),
            &metric.north(m, i + 1, 0),           &metric.north(m, i, 0),
            &metric.diagonal(m, i + 1, 0),        &metric.diagonal(m, i, 0),
            &metric.inverse_mass(m, i + 1, 0)};
  }

  KOKKOS_FORCEINLINE_FUNCTION Real at(const ConstView& V, int m, int i, int j) const {
    return row(V, m, i)(mirrored(j - 1, grid.columns), j, mirrored(j + 1, grid.columns));
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
    const Real* KOKKOS_RESTRICT below;
    const Real* KOKKOS_RESTRICT here;
    const Real* KOKKOS_RESTRICT above;
    const Real* KOKKOS_RESTRICT g11;
    const Real* KOKKOS_RESTRICT g12;
    const Real* KOKKOS_RESTRICT g22;
    const Real* KOKKOS_RESTRICT b1;
    const Real* KOKKOS_RESTRICT b2;
    Real half_inverse_dx;
    Real inverse_dx2;
    KOKKOS_FORCEINLINE_FUNCTION Real operator()(int west, int j, int east) const {
      const Real V_11 = inverse_dx2 * (here[east] - Real(2) * here[j] + here[west]);
      const Real V_22 = inverse_dx2 * (above[j] - Real(2) * here[j] + below[j]);
      const Real V_12 = Real(0.25) * inverse_dx2 * (above[east] - above[west] - below[east] + below[west]);
      const Real V_1 = half_inverse_dx * (here[east] - here[west]);
      const Real V_2 = half_inverse_dx * (above[j] - below[j]);
      return g11[j] * V_11 + Real(2) * g12[j] * V_12 + g22[j] * V_22 - b1[j] * V_1 - b2[j] * V_2;
    }
  };

  KOKKOS_FORCEINLINE_FUNCTION bool row_is_regular(int i) const { return i > 0 && i < grid.rows - 1; }

  KOKKOS_FORCEINLINE_FUNCTION Row row(const ConstView& V, int m, int i) const {
    return {&V(m, i - 1, 0),      &V(m, i, 0),          &V(m, i + 1, 0),     &metric.g11(m, i, 0),
            &metric.g12(m, i, 0), &metric.g22(m, i, 0), &metric.b1(m, i, 0), &metric.b2(m, i, 0),
            half_inverse_dx,      inverse_dx2};
  }

  KOKKOS_FUNCTION Real at(const ConstView& V, int m, int i, int j) const {
    const bool side = j == 0 || j == grid.columns - 1;
    const bool end = i == 0 || i == grid.rows - 1;
    if (!side && !end) return row(V, m, i)(j - 1, j, j + 1);

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
