// Phase singularities (spiral tips): grid squares around whose four nodes (V - 0.5, dV/dt) winds by
// +-2 pi, found on the device and compacted, so that no field goes to the host. The same sweep gives
// the largest V, by which the death of all activity is told.
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::observe {

// A square with non-zero winding; position in material coordinates, length units.
struct PhaseSingularity {
  int member, row, column;  // lower left node of the square
  int charge;               // +1: counter-clockwise, columns to the right, rows up
  double x, y;
};

// Values at the corners of a square in the order (0,0), (1,0), (1,1), (0,1) of (column, row):
// counter-clockwise.
struct Corners {
  double value[4];
};

// Times that the closed polygon (u, v) winds round the origin, counter-clockwise positive: each
// crossing of the positive v axis counts by its direction.
KOKKOS_INLINE_FUNCTION int winding_number(const Corners& u, const Corners& v) {
  int turns = 0;
  for (int c = 0; c < 4; ++c) {
    const int d = (c + 1) % 4;
    const double ua = u.value[c], ub = u.value[d];
    if ((ua < 0) == (ub < 0)) continue;
    // v where the segment crosses u = 0, times (ua - ub)^2 > 0
    const double crossing = (ua * v.value[d] - ub * v.value[c]) * (ua - ub);
    if (crossing > 0) turns += ub < 0 ? 1 : -1;
  }
  return turns;
}

// (xi_1, xi_2) in the unit square where both bilinear interpolants vanish; the corner values must
// wind round zero, so that there is such a point.
KOKKOS_INLINE_FUNCTION Kokkos::pair<double, double> bilinear_root(const Corners& u, const Corners& v) {
  // u = a0 + a1 s + a2 t + a3 s t, v likewise with b; eliminating s leaves a quadratic in t.
  const double a0 = u.value[0], a1 = u.value[1] - a0, a2 = u.value[3] - a0,
               a3 = u.value[2] - u.value[1] - u.value[3] + a0;
  const double b0 = v.value[0], b1 = v.value[1] - b0, b2 = v.value[3] - b0,
               b3 = v.value[2] - v.value[1] - v.value[3] + b0;
  const double A = b2 * a3 - b3 * a2, B = b0 * a3 + b2 * a1 - b1 * a2 - b3 * a0, C = b0 * a1 - b1 * a0;
  const double root = Kokkos::sqrt(Kokkos::max(0.0, B * B - 4 * A * C));
  const double q = -0.5 * (B + (B < 0 ? -root : root));
  const double candidates[2] = {A != 0 ? q / A : -1, q != 0 ? C / q : -1};
  Kokkos::pair<double, double> best{0.5, 0.5};
  double best_outside = 1e300;
  for (const double t : candidates) {
    // the interpolant with the larger slope along s gives s
    const double du = a1 + a3 * t, dv = b1 + b3 * t;
    if (du == 0 && dv == 0) continue;
    const double s = Kokkos::abs(du) > Kokkos::abs(dv) ? -(a0 + a2 * t) / du : -(b0 + b2 * t) / dv;
    const double outside = Kokkos::max(Kokkos::abs(s - 0.5), Kokkos::abs(t - 0.5));
    if (outside < best_outside) {
      best_outside = outside;
      best = {s, t};
    }
  }
  return {Kokkos::clamp(best.first, 0.0, 1.0), Kokkos::clamp(best.second, 0.0, 1.0)};
}

// Squares are looked at in blocks of so many columns.
inline constexpr int block_columns = 32;

// For columns first ... last (both included, at most block_columns + 1 of them) of two rows: how many
// of the two nodes have V >= 0.5. Returns the largest V of the first row.
template <class Real>
KOKKOS_INLINE_FUNCTION Real count_high_nodes(const Real* here, const Real* above, int first, int last,
                                             int* high) {
  Real largest = here[first];
#pragma omp simd reduction(max : largest)
  for (int j = first; j <= last; ++j) {
    high[j - first] = (here[j] >= Real(0.5) ? 1 : 0) + (above[j] >= Real(0.5) ? 1 : 0);
    largest = here[j] > largest ? here[j] : largest;
  }
  return largest;
}

// Appends the singularities of all members to `found` in any order (the caller sorts); `count` is
// how many there are, which may exceed the room in `found`. Rate: dV/dt at (member, row, column).
//
//   view    shape                      unit   access
//   V       (members, rows, columns)   -      read
//   count   ()                         -      read and write, must be zero
//   found   (room)                     -      write
//
// Returns the largest V of all members; waits for it.
template <class ExecutionSpace, class View, class Rate, class MemorySpace>
double find_phase_singularities(const ExecutionSpace& space, const tissue::Grid& grid, const View& V,
                                const Rate& rate, const Kokkos::View<int, MemorySpace>& count,
                                const Kokkos::View<PhaseSingularity*, MemorySpace>& found) {
  using Real = typename View::non_const_value_type;
  const int rows = grid.rows, columns = grid.columns;
  const double dx = grid.dx;
  double largest_V = 0;
  Kokkos::parallel_reduce(
      "myowave::observe::find_phase_singularities",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(V.extent(0)) * rows),
      KOKKOS_LAMBDA(int row, double& largest) {
        const int m = row / rows, i = row % rows;
        // The last row has no squares of its own; it is looked at for the largest V.
        const int above = i + 1 < rows ? i + 1 : i;
        for (int first = 0; first < columns; first += block_columns) {
          const int last = Kokkos::min(first + block_columns, columns - 1);
          int high[block_columns + 1];
          const Real highest = count_high_nodes(&V(m, i, 0), &V(m, above, 0), first, last, high);
          largest = Kokkos::max(largest, double(highest));
          if (above == i) continue;
          for (int j = first; j < last; ++j) {
            const int high_corners = high[j - first] + high[j - first + 1];
            if (high_corners == 0 || high_corners == 4) continue;
            const Corners u{
                {V(m, i, j) - 0.5, V(m, i, j + 1) - 0.5, V(m, i + 1, j + 1) - 0.5, V(m, i + 1, j) - 0.5}};
            const Corners v{{double(rate(m, i, j)), double(rate(m, i, j + 1)), double(rate(m, i + 1, j + 1)),
                             double(rate(m, i + 1, j))}};
            const int charge = winding_number(u, v);
            if (charge == 0) continue;
            const auto at = bilinear_root(u, v);
            const int slot = Kokkos::atomic_fetch_inc(&count());
            if (slot < static_cast<int>(found.extent(0)))
              found(slot) = {m, i, j, charge, dx * (j + at.first), dx * (i + at.second)};
          }
        }
      },
      Kokkos::Max<double>(largest_V));
  return largest_V;
}

}  // namespace myowave::observe
