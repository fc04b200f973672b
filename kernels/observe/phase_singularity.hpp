// Phase singularities (spiral tips): grid squares around whose four nodes (V - 0.5, dV/dt) winds by
// +-2 pi, found on the device and compacted, so that no field goes to the host. The same pass gives
// the largest V, by which the death of all activity is told.
#pragma once

#include <cstdint>

#include "kernels/base/row_loop.hpp"
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

// Nodes of a row are inspected together, a bit each; they are the corners of so many squares.
inline constexpr int block_columns = 63;

// Bit k: V[k] >= 0.5, for k < nodes <= 64. `largest` becomes at least the largest V of them.
template <class Real>
KOKKOS_INLINE_FUNCTION std::uint64_t high_nodes(const Real* V, int nodes, double& largest) {
  std::uint64_t high = 0;
  Real most = V[0];
  const auto inspect = [&](int n) {
#pragma omp simd reduction(| : high) reduction(max : most)
    for (int k = 0; k < n; ++k) {
      high |= std::uint64_t(V[k] >= Real(0.5) ? 1 : 0) << k;
      most = V[k] > most ? V[k] : most;
    }
  };
  if (nodes == block_columns + 1)
    inspect(block_columns + 1);  // most are; a loop of known length
  else
    inspect(nodes);
  largest = Kokkos::max(largest, double(most));
  return high;
}

// Of the nodes of a row: bits of those whose rate is surely so or not asked for.
struct RateSigns {
  std::uint64_t positive, not_positive;
};

// Asks for the rates of the nodes `asked` of row i, bit 0 being column `first`. What is positive is so far
// from zero that its product with V - 0.5 does not vanish.
template <class Rate>
KOKKOS_INLINE_FUNCTION RateSigns rate_signs(const Rate& rate, int m, int i, int first, std::uint64_t asked) {
  constexpr double vanishing = 1e-30;
  RateSigns signs{~asked, ~asked};
  for (std::uint64_t rest = asked; rest != 0; rest &= rest - 1) {
    const int k = Kokkos::countr_zero(rest);
    const double v = double(rate(m, i, first + k));
    signs.positive |= std::uint64_t(v > vanishing ? 1 : 0) << k;
    signs.not_positive |= std::uint64_t(v <= 0 ? 1 : 0) << k;
  }
  return signs;
}

// Bits of the squares whose four corners all have their bit.
KOKKOS_INLINE_FUNCTION std::uint64_t all_corners(std::uint64_t below, std::uint64_t above) {
  return below & below >> 1 & above & above >> 1;
}

// What find_phase_singularities() does in a tile of squares. The winding of a square is not zero only where V
// crosses 0.5 along some of its edges and the rate has not one sign at all ends of these: the rate is asked
// for at such nodes alone, once, and a square that passes is inspected in full.
template <class View, class Rate, class MemorySpace>
struct SingularitySearch {
  using Real = typename View::non_const_value_type;
  tissue::Grid grid;
  View V;
  Rate rate;
  Kokkos::View<int, MemorySpace> count;
  Kokkos::View<PhaseSingularity*, MemorySpace> found;
  int rows_per_tile, tiles_in_column, tiles_in_row;

  KOKKOS_FUNCTION void operator()(int tile, double& largest) const {
    const int m = tile / (tiles_in_column * tiles_in_row);
    const int first_row = tile / tiles_in_row % tiles_in_column * rows_per_tile;
    const int last_row = Kokkos::min(first_row + rows_per_tile, grid.rows - 1);
    const int first = tile % tiles_in_row * block_columns;
    const int nodes = Kokkos::min(block_columns + 1, grid.columns - first);
    const std::uint64_t squares = ~std::uint64_t(0) >> (65 - nodes);

    std::uint64_t high = high_nodes(&V(m, first_row, first), nodes, largest), high_below = high;
    RateSigns signs_below{};
    for (int i = first_row; i <= last_row; ++i) {
      const std::uint64_t high_above = i < last_row ? high_nodes(&V(m, i + 1, first), nodes, largest) : high;
      const std::uint64_t along = (high ^ high >> 1) & squares;
      const std::uint64_t ends = along | along << 1 | (high ^ high_below) | (high ^ high_above);
      const RateSigns signs = rate_signs(rate, m, i, first, ends);
      if (i > first_row) {
        const std::uint64_t crossed =
            squares & ~all_corners(high_below, high) & ~all_corners(~high_below, ~high);
        const std::uint64_t one_sign = all_corners(signs_below.positive, signs.positive) |
                                       all_corners(signs_below.not_positive, signs.not_positive);
        for (std::uint64_t rest = crossed & ~one_sign; rest != 0; rest &= rest - 1)
          inspect_square(m, i - 1, first + Kokkos::countr_zero(rest));
      }
      high_below = high;
      high = high_above;
      signs_below = signs;
    }
  }

  KOKKOS_FUNCTION void inspect_square(int m, int i, int j) const {
    const Corners u{{V(m, i, j) - 0.5, V(m, i, j + 1) - 0.5, V(m, i + 1, j + 1) - 0.5, V(m, i + 1, j) - 0.5}};
    const Corners v{{double(rate(m, i, j)), double(rate(m, i, j + 1)), double(rate(m, i + 1, j + 1)),
                     double(rate(m, i + 1, j))}};
    const int charge = winding_number(u, v);
    if (charge == 0) return;
    const auto at = bilinear_root(u, v);
    const int slot = Kokkos::atomic_fetch_inc(&count());
    if (slot < static_cast<int>(found.extent(0)))
      found(slot) = {m, i, j, charge, grid.dx * (j + at.first), grid.dx * (i + at.second)};
  }
};

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
  // A thread of a host reads each row of its tile once, one of a device at a row of squares.
  const int rows_per_tile = runs_on_host<ExecutionSpace> ? 16 : 1;
  const int tiles_in_column = tissue::tiles_of(grid.rows - 1, rows_per_tile);
  const int tiles_in_row = tissue::tiles_of(grid.columns - 1, block_columns);
  const SingularitySearch<View, Rate, MemorySpace> search{
      grid, V, rate, count, found, rows_per_tile, tiles_in_column, tiles_in_row};
  double largest_V = 0;
  Kokkos::parallel_reduce("myowave::observe::find_phase_singularities",
                          Kokkos::RangePolicy<ExecutionSpace>(
                              space, 0, static_cast<int>(V.extent(0)) * tiles_in_column * tiles_in_row),
                          search, Kokkos::Max<double>(largest_V));
  return largest_V;
}

}  // namespace myowave::observe
