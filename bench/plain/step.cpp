#include "bench/plain/step.hpp"

#include <algorithm>
#include <vector>

#if defined(_OPENMP)
#include <omp.h>
#endif

namespace myowave::plain {

template <class Real>
Array<Real>::Array(std::size_t size) : size_(size) {
  constexpr std::size_t line = 64;
  const std::size_t bytes = (size * sizeof(Real) + line - 1) / line * line;
  auto* memory = static_cast<Real*>(std::aligned_alloc(line, bytes));
  if (memory == nullptr) throw std::bad_alloc();
  memory_.reset(memory);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < size; ++k) memory[k] = 0;
}

template <class Real>
EdgeNetwork<Real>::EdgeNetwork(int nodes_a_side)
    : n(nodes_a_side),
      east(static_cast<std::size_t>(n + 1) * (n + 1)),
      north(east.size()),
      rising(east.size()),
      falling(east.size()),
      inverse_mass(east.size()) {}

template <class Real>
void EdgeNetwork<Real>::refresh(int cells, double dx, std::span<const double> nodes) {
  const int elements = (n - 1) / cells, pitch = n + 1;
  const double h = cells * dx;
  struct Cell {
    double G11 = 0, G12 = 0, G22 = 0, sqrt_C = 0;
  };
  // Cell (i, j) at (i + 1, j + 1), zero outside the sheet.
  std::vector<Cell> cell(static_cast<std::size_t>(pitch) * pitch);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n - 1; ++i)
    for (int j = 0; j < n - 1; ++j) {
      const int I = i / cells, J = j / cells;
      const double xi1 = (j - J * cells + 0.5) / cells, xi2 = (i - I * cells + 0.5) / cells;
      double F[2][2];
      for (int k = 0; k < 2; ++k) {
        const auto x = [&](int a, int b) { return nodes[2 * ((I + b) * (elements + 1) + J + a) + k]; };
        F[k][0] = ((1 - xi2) * (x(1, 0) - x(0, 0)) + xi2 * (x(1, 1) - x(0, 1))) / h;
        F[k][1] = ((1 - xi1) * (x(0, 1) - x(0, 0)) + xi1 * (x(1, 1) - x(1, 0))) / h;
      }
      const double det = F[0][0] * F[1][1] - F[0][1] * F[1][0];
      cell[static_cast<std::size_t>(i + 1) * pitch + j + 1] = {
          (F[0][1] * F[0][1] + F[1][1] * F[1][1]) / det, -(F[0][0] * F[0][1] + F[1][0] * F[1][1]) / det,
          (F[0][0] * F[0][0] + F[1][0] * F[1][0]) / det, det};
    }
#pragma omp parallel for schedule(static)
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= n; ++j) {
      const std::size_t node = static_cast<std::size_t>(i) * pitch + j;
      const Cell &right = cell[node], &left = cell[node - 1], &right_below = cell[node - pitch],
                 &left_below = cell[node - pitch - 1];
      east[node] = static_cast<Real>((right.G11 + right_below.G11) / 2);
      north[node] = static_cast<Real>((right.G22 + left.G22) / 2);
      rising[node] = static_cast<Real>(right.G12 / 2);
      falling[node] = static_cast<Real>(-right.G12 / 2);
      inverse_mass[node] = static_cast<Real>(
          4 / ((right.sqrt_C + left.sqrt_C + right_below.sqrt_C + left_below.sqrt_C) * dx * dx));
    }
}

namespace {

template <class Real>
struct Node {
  Real V, r, Ta;
};

template <class Real>
inline Node<Real> updated(const Constants<Real>& c, Real V, Real r, Real Ta, Real diffusion) {
  return {V + c.dt * c.inverse_C_m * (c.D * diffusion - c.k * V * (V - c.a) * (V - Real(1)) - r * V),
          r + c.dt * (c.eps + c.mu1 * r / (c.mu2 + V)) * (-r - c.k * V * (V - c.b - Real(1))),
          Ta + c.dt * (V < c.threshold ? c.eps_below : c.eps_above) * (c.k_Ta * V - Ta)};
}

// A step reads more streams, with more arithmetic between two lines of one stream, than the hardware
// prefetcher follows. With hints the plain step comes nearer to the bandwidth of the triad.
template <class Real, class... Streams>
inline void prefetch(int begin, int end, const Streams*... streams) {
  constexpr int line = 64 / sizeof(Real), distance = 2048 / sizeof(Real);  // columns
  for (int j = begin; j < end; j += line) (__builtin_prefetch(streams + j + distance), ...);
}

// body(west, j, east) along a row, mirrored at its ends; `streams` are the arrays to prefetch.
template <class Real, class Body, class... Streams>
inline void along_row(int n, const Body& body, const Streams*... streams) {
  constexpr int block = 256 / sizeof(Real);  // columns between two rounds of hints
  body(1, 0, 1);
  for (int begin = 1; begin < n - 1; begin += block) {
    const int end = std::min(begin + block, n - 1);
    prefetch<Real>(begin, end, streams...);
#pragma omp simd
    for (int j = begin; j < end; ++j) body(j - 1, j, j + 1);
  }
  body(n - 2, n - 1, n - 2);
}

// The row functions take every row as a separate pointer: pointers in a struct would be stored and read back
// at every call. The constants are copied, so that the compiler knows that no store to a field changes them.
template <class Real>
void identity_row(const Constants<Real>& constants, int n, const Real* __restrict below,
                  const Real* __restrict V, const Real* __restrict above, const Real* __restrict r,
                  const Real* __restrict Ta, Real* __restrict V_next, Real* __restrict r_next,
                  Real* __restrict Ta_next) {
  const Constants<Real> c = constants;
  const Real inverse_dx2 = 1 / (c.dx * c.dx);
  const auto update = [=](int west, int j, int east) {
    const Real sum = (V[west] + V[east]) + (below[j] + above[j]);
    const auto next = updated(c, V[j], r[j], Ta[j], inverse_dx2 * (sum - Real(4) * V[j]));
    V_next[j] = next.V;
    r_next[j] = next.r;
    Ta_next[j] = next.Ta;
  };
  along_row<Real>(n, update, above, r, Ta, V_next, r_next, Ta_next);
}

// Weights are shifted by one: [j + 1] belongs to column j.
template <class Real>
void conservative_row(const Constants<Real>& constants, int n, const Real* __restrict east_weight,
                      const Real* __restrict north, const Real* __restrict north_below,
                      const Real* __restrict rising, const Real* __restrict rising_below,
                      const Real* __restrict falling, const Real* __restrict falling_below,
                      const Real* __restrict inverse_mass, const Real* __restrict below,
                      const Real* __restrict V, const Real* __restrict above, const Real* __restrict r,
                      const Real* __restrict Ta, Real* __restrict V_next, Real* __restrict r_next,
                      Real* __restrict Ta_next) {
  const Constants<Real> c = constants;
  const auto update = [=](int west, int j, int east) {
    const Real here = V[j];
    const Real straight = east_weight[j + 1] * (V[east] - here) + east_weight[j] * (V[west] - here) +
                          north[j + 1] * (above[j] - here) + north_below[j + 1] * (below[j] - here);
    const Real oblique = rising[j + 1] * (above[east] - here) + rising_below[j] * (below[west] - here) +
                         falling[j] * (above[west] - here) + falling_below[j + 1] * (below[east] - here);
    const auto next = updated(c, here, r[j], Ta[j], inverse_mass[j + 1] * (straight + oblique));
    V_next[j] = next.V;
    r_next[j] = next.r;
    Ta_next[j] = next.Ta;
  };
  along_row<Real>(n, update, above, r, Ta, east_weight, north, rising, falling, inverse_mass, V_next, r_next,
                  Ta_next);
}

// One thread's rows in one call, so that one thread and many run the same instructions.
template <class Real>
[[gnu::noinline]] void identity_rows(const Constants<Real>& c, int n, const Fields<Real>& old,
                                     const Fields<Real>& next, int first, int last) {
  for (int i = first; i < last; ++i) {
    const std::size_t row = static_cast<std::size_t>(i) * n;
    const std::size_t below = i > 0 ? row - n : row + n, above = i < n - 1 ? row + n : row - n;
    identity_row(c, n, &old.V[below], &old.V[row], &old.V[above], &old.r[row], &old.Ta[row], &next.V[row],
                 &next.r[row], &next.Ta[row]);
  }
}

template <class Real>
[[gnu::noinline]] void conservative_rows(const Constants<Real>& c, const EdgeNetwork<Real>& w,
                                         const Fields<Real>& old, const Fields<Real>& next, int first,
                                         int last) {
  const int n = w.n;
  for (int i = first; i < last; ++i) {
    const std::size_t row = static_cast<std::size_t>(i) * n;
    const std::size_t below = i > 0 ? row - n : row + n, above = i < n - 1 ? row + n : row - n;
    const std::size_t here = static_cast<std::size_t>(i + 1) * (n + 1), lower = here - (n + 1);
    conservative_row(c, n, &w.east[here], &w.north[here], &w.north[lower], &w.rising[here], &w.rising[lower],
                     &w.falling[here], &w.falling[lower], &w.inverse_mass[here], &old.V[below], &old.V[row],
                     &old.V[above], &old.r[row], &old.Ta[row], &next.V[row], &next.r[row], &next.Ta[row]);
  }
}

// body(first, last) with each thread's share of n rows.
template <class Body>
void share_rows(Threads threads, int n, const Body& body) {
#if defined(_OPENMP)
  if (threads == Threads::all) {
#pragma omp parallel
    {
      const long thread = omp_get_thread_num(), count = omp_get_num_threads();
      body(static_cast<int>(thread * n / count), static_cast<int>((thread + 1) * n / count));
    }
    return;
  }
#endif
  body(0, n);
}

}  // namespace

template <class Real>
void step_identity(Threads threads, const Constants<Real>& c, int n, const Fields<Real>& old,
                   const Fields<Real>& next) {
  share_rows(threads, n, [&](int first, int last) { identity_rows(c, n, old, next, first, last); });
}

template <class Real>
void step_conservative(Threads threads, const Constants<Real>& c, const EdgeNetwork<Real>& w,
                       const Fields<Real>& old, const Fields<Real>& next) {
  share_rows(threads, w.n, [&](int first, int last) { conservative_rows(c, w, old, next, first, last); });
}

template class Array<double>;
template class Array<float>;
template struct EdgeNetwork<double>;
template struct EdgeNetwork<float>;
template void step_identity(Threads, const Constants<double>&, int, const Fields<double>&,
                            const Fields<double>&);
template void step_identity(Threads, const Constants<float>&, int, const Fields<float>&,
                            const Fields<float>&);
template void step_conservative(Threads, const Constants<double>&, const EdgeNetwork<double>&,
                                const Fields<double>&, const Fields<double>&);
template void step_conservative(Threads, const Constants<float>&, const EdgeNetwork<float>&,
                                const Fields<float>&, const Fields<float>&);

}  // namespace myowave::plain
