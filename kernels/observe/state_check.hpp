// What is checked of a state, in one pass over V, r and Ta: finite values, the range of V and r, and
// grid-scale noise, that is how much of V alternates from node to node. The first mode of the explicit step
// that grows past its stability bound is the checkerboard (-1)^(i+j), for every deformation; the reaction
// then holds it at a finite amplitude, so that such a run is wrong without ever blowing up.
//   noise = 1/16 |V_xx V_yy|_h = 1/16 |sum over the 3 x 3 patch of (1, -2, 1) (x) (1, -2, 1) V|
// is A on a checkerboard of amplitude A and 0 on a field of one coordinate alone. Edges are mirrored, as
// the step sees them.
//
// A sharp front has noise too, where the grid resolves it badly. What no stable step does is to turn its
// sign from step to step without letting it decay: growing_noise() asks for that.
//
//   view        shape                      unit      access
//   V, r, Ta    (members, rows, columns)   -, kPa    read; at least 2 rows and 2 columns
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::observe {

// Of all members. Where a value is not finite the others mean nothing.
struct InspectedState {
  long first_non_finite = -1;  // linear index (member rows + row) columns + column of the first such node
  double noise = 0;            // largest over all patches
  double min_V = 0, max_V = 0, min_r = 0;
};

namespace detail {

// Column of the first node of a row where V, r or Ta is not finite; -1: none.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION int non_finite_column(const Real* V, const Real* r, const Real* Ta, int columns) {
  // 0 * x is 0 for a finite x and NaN otherwise: one SIMD sum checks a whole row.
  Real sum = 0;
#pragma omp simd reduction(+ : sum)
  for (int j = 0; j < columns; ++j) sum += Real(0) * (V[j] + r[j] + Ta[j]);
  if (sum == Real(0)) return -1;
  for (int j = 0; j < columns; ++j)
    if (!Kokkos::isfinite(V[j]) || !Kokkos::isfinite(r[j]) || !Kokkos::isfinite(Ta[j])) return j;
  return -1;
}

// The noise at column j from the three rows of V around it; west and east are the neighbouring columns.
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION Real noise_at(const Real* below, const Real* here, const Real* above, int west,
                                          int j, int east) {
  const auto bent = [&](int column) { return below[column] - 2 * here[column] + above[column]; };
  return Kokkos::abs(bent(west) - 2 * bent(j) + bent(east)) * Real(0.0625);
}

template <class Real>
KOKKOS_FORCEINLINE_FUNCTION Real noise_of_row(const Real* below, const Real* here, const Real* above,
                                              int columns) {
  const int last = columns - 1;
  Real largest = Kokkos::max(noise_at(below, here, above, 1, 0, 1),
                             noise_at(below, here, above, last - 1, last, last - 1));
#pragma omp simd reduction(max : largest)
  for (int j = 1; j < last; ++j) {
    const Real at = noise_at(below, here, above, j - 1, j, j + 1);
    largest = at > largest ? at : largest;
  }
  return largest;
}

}  // namespace detail

// Waits for the result. Ta may be empty. Minima and maxima only, so that the number of threads changes
// nothing.
template <class ExecutionSpace, class View>
InspectedState inspect_state(const ExecutionSpace& space, const View& V, const View& r, const View& Ta) {
  using Real = typename View::non_const_value_type;
  const int rows = static_cast<int>(V.extent(1)), columns = static_cast<int>(V.extent(2));
  const View tension = Ta.size() > 0 ? Ta : r;
  constexpr long none = Kokkos::reduction_identity<long>::min();
  InspectedState found;
  Kokkos::parallel_reduce(
      "myowave::observe::inspect_state",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(V.extent(0)) * rows),
      KOKKOS_LAMBDA(int row, long& first, double& noise, double& min_V, double& max_V, double& min_r) {
        const int m = row / rows, i = row % rows;
        const Real *const here = &V(m, i, 0), *const recovery = &r(m, i, 0);
        const int column = detail::non_finite_column(here, recovery, &tension(m, i, 0), columns);
        if (column >= 0) first = Kokkos::min(first, long(row) * columns + column);

        const Real largest = detail::noise_of_row(&V(m, tissue::mirrored(i - 1, rows), 0), here,
                                                  &V(m, tissue::mirrored(i + 1, rows), 0), columns);
        Real low = here[0], high = here[0], low_r = recovery[0];
#pragma omp simd reduction(min : low, low_r) reduction(max : high)
        for (int j = 0; j < columns; ++j) {
          low = here[j] < low ? here[j] : low;
          high = here[j] > high ? here[j] : high;
          low_r = recovery[j] < low_r ? recovery[j] : low_r;
        }
        noise = Kokkos::max(noise, double(largest));
        min_V = Kokkos::min(min_V, double(low));
        max_V = Kokkos::max(max_V, double(high));
        min_r = Kokkos::min(min_r, double(low_r));
      },
      Kokkos::Min<long>(found.first_non_finite), Kokkos::Max<double>(found.noise),
      Kokkos::Min<double>(found.min_V), Kokkos::Max<double>(found.max_V), Kokkos::Min<double>(found.min_r));
  if (found.first_non_finite == none) found.first_non_finite = -1;
  return found;
}

// Where the next step, of length dt, turns the sign of the noise and does not make it smaller.
struct GrowingNoise {
  double noise = 0;  // largest of those; 0: nowhere
  long node = -1;    // its linear index (member rows + row) columns + column
};

// Among nodes whose noise is at least `threshold`. Rate: dV/dt at (member, row, column). Waits for the
// result.
template <class ExecutionSpace, class View, class Rate>
GrowingNoise growing_noise(const ExecutionSpace& space, const View& V, const Rate& rate, double dt,
                           double threshold) {
  const int rows = static_cast<int>(V.extent(1)), columns = static_cast<int>(V.extent(2));
  using Largest = Kokkos::MaxLoc<double, long>;
  typename Largest::value_type found;
  Kokkos::parallel_reduce(
      "myowave::observe::growing_noise",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(V.extent(0)) * rows),
      KOKKOS_LAMBDA(int row, typename Largest::value_type& largest) {
        const int m = row / rows, i = row % rows;
        const auto weight = [](int offset) { return offset == 0 ? -2.0 : 1.0; };
        const auto component = [&](const auto& field, int j) {
          double sum = 0;
          for (int a = -1; a <= 1; ++a)
            for (int b = -1; b <= 1; ++b)
              sum += weight(a) * weight(b) *
                     double(field(m, tissue::mirrored(i + a, rows), tissue::mirrored(j + b, columns)));
          return 0.0625 * sum;
        };
        for (int j = 0; j < columns; ++j) {
          const double now = component(V, j);
          if (Kokkos::abs(now) < threshold || Kokkos::abs(now) <= largest.val) continue;
          const double next = now + dt * component(rate, j);
          if (now * next < 0 && Kokkos::abs(next) >= Kokkos::abs(now))
            largest = {Kokkos::abs(now), long(row) * columns + j};
        }
      },
      Largest(found));
  return found.val > 0 ? GrowingNoise{found.val, found.loc} : GrowingNoise{};
}

}  // namespace myowave::observe
