// Diffusion in the expanded form of Eq 24 on the deformed metric (see diffusion.hpp).
#pragma once

#include "kernels/tissue/metric.hpp"
#include "kernels/tissue/stencil_rows.hpp"

namespace myowave::tissue {

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
