// Grid-scale noise: how much of V alternates from node to node. The first mode of the explicit step that
// grows past its stability bound is the checkerboard (-1)^(i+j), for every deformation; the reaction then
// holds it at a finite amplitude, so that such a run is wrong without ever blowing up.
//   noise = 1/16 |V_xx V_yy|_h = 1/16 |sum over the 3 x 3 patch of (1, -2, 1) (x) (1, -2, 1) V|
// is A on a checkerboard of amplitude A and 0 on a field of one coordinate alone. Edges are mirrored, as
// the step sees them.
//
//   view    shape                      unit   access
//   V       (members, rows, columns)   -      read
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::observe {

struct FieldRange {
  double noise = 0;  // largest over all patches
  double min_V = 0, max_V = 0;
};

// The noise at node (i, j) from the three rows around it; west and east are the neighbouring columns.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION Real grid_noise_at(const Real* below, const Real* here, const Real* above,
                                               int west, int j, int east) {
  const auto bent = [&](int column) { return below[column] - 2 * here[column] + above[column]; };
  return Kokkos::abs(bent(west) - 2 * bent(j) + bent(east)) * Real(0.0625);
}

// Of all members; waits for the result. Maxima only, so that it depends on no number of threads. What is
// not finite is passed over: see first_non_finite.
template <class ExecutionSpace, class View>
FieldRange grid_noise(const ExecutionSpace& space, const View& V) {
  using Real = typename View::non_const_value_type;
  const int rows = static_cast<int>(V.extent(1)), columns = static_cast<int>(V.extent(2));
  FieldRange range;
  Kokkos::parallel_reduce(
      "myowave::observe::grid_noise",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(V.extent(0)) * rows),
      KOKKOS_LAMBDA(int row, double& noise, double& min_V, double& max_V) {
        const int m = row / rows, i = row % rows, last = columns - 1;
        const Real* const below = &V(m, tissue::mirrored(i - 1, rows), 0);
        const Real* const here = &V(m, i, 0);
        const Real* const above = &V(m, tissue::mirrored(i + 1, rows), 0);
        Real largest = Kokkos::max(grid_noise_at(below, here, above, 1, 0, 1),
                                   grid_noise_at(below, here, above, last - 1, last, last - 1));
        Real low = here[0], high = here[0];
#pragma omp simd reduction(max : largest)
        for (int j = 1; j < last; ++j) {
          const Real at = grid_noise_at(below, here, above, j - 1, j, j + 1);
          largest = at > largest ? at : largest;
        }
#pragma omp simd reduction(min : low) reduction(max : high)
        for (int j = 0; j < columns; ++j) {
          low = here[j] < low ? here[j] : low;
          high = here[j] > high ? here[j] : high;
        }
        noise = Kokkos::max(noise, double(largest));
        min_V = Kokkos::min(min_V, double(low));
        max_V = Kokkos::max(max_V, double(high));
      },
      Kokkos::Max<double>(range.noise), Kokkos::Min<double>(range.min_V), Kokkos::Max<double>(range.max_V));
  return range;
}

}  // namespace myowave::observe
