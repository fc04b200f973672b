#include "bench/plain/step.hpp"

#include <algorithm>
#include <vector>

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

// What one row reads and writes.
template <class Real>
struct Row {
  const Real* __restrict below, * __restrict V, * __restrict above, * __restrict r, * __restrict Ta;
  Real* __restrict V_next, * __restrict r_next, * __restrict Ta_next;

  Row(int i, int n, const Fields<Real>& old, const Fields<Real>& next) {
    const auto row = [n](const Array<Real>& field, int k) {
      return field.data() + static_cast<std::size_t>(k) * n;
    };
    below = row(old.V, i > 0 ? i - 1 : 1);
    V = row(old.V, i);
    above = row(old.V, i < n - 1 ? i + 1 : n - 2);
    r = row(old.r, i);
    Ta = row(old.Ta, i);
    V_next = row(next.V, i);
    r_next = row(next.r, i);
    Ta_next = row(next.Ta, i);
  }
};

template <class Real>
inline void update(const Constants<Real>& c, const Row<Real>& row, int j, Real diffusion) {
  const Real V = row.V[j], r = row.r[j], Ta = row.Ta[j];
  row.V_next[j] = V + c.dt * c.inverse_C_m * (c.D * diffusion - c.k * V * (V - c.a) * (V - Real(1)) - r * V);
  row.r_next[j] = r + c.dt * (c.eps + c.mu1 * r / (c.mu2 + V)) * (-r - c.k * V * (V - c.b - Real(1)));
  row.Ta_next[j] = Ta + c.dt * (V < c.threshold ? c.eps_below : c.eps_above) * (c.k_Ta * V - Ta);
}

// body(west, j, east) along a row, mirrored at its ends.
template <class Body>
inline void along_row(int n, const Body& body) {
  body(1, 0, 1);
#pragma omp simd
  for (int j = 1; j < n - 1; ++j) body(j - 1, j, j + 1);
  body(n - 2, n - 1, n - 2);
}

template <class Real>
void identity_row(const Constants<Real>& c, Real inverse_dx2, int n, const Row<Real> row) {
  along_row(n, [=](int west, int j, int east) {
    const Real sum = (row.V[west] + row.V[east]) + (row.below[j] + row.above[j]);
    update(c, row, j, inverse_dx2 * (sum - Real(4) * row.V[j]));
  });
}

// Weights are shifted by one: [j + 1] is that of column j.
template <class Real>
struct WeightRow {
  const Real* __restrict east, * __restrict north, * __restrict north_below, * __restrict rising, * __restrict rising_below, * __restrict falling, * __restrict falling_below, * __restrict inverse_mass;

  WeightRow(int i, const EdgeNetwork<Real>& w) {
    const std::size_t here = static_cast<std::size_t>(i + 1) * (w.n + 1), lower = here - (w.n + 1);
    east = w.east.data() + here;
    north = w.north.data() + here;
    north_below = w.north.data() + lower;
    rising = w.rising.data() + here;
    rising_below = w.rising.data() + lower;
    falling = w.falling.data() + here;
    falling_below = w.falling.data() + lower;
    inverse_mass = w.inverse_mass.data() + here;
  }
};

template <class Real>
void conservative_row(const Constants<Real>& c, int n, const Row<Real> row, const WeightRow<Real> w) {
  along_row(n, [=](int west, int j, int east) {
    const Real V = row.V[j];
    const Real straight = w.east[j + 1] * (row.V[east] - V) + w.east[j] * (row.V[west] - V) +
                          w.north[j + 1] * (row.above[j] - V) + w.north_below[j + 1] * (row.below[j] - V);
    const Real oblique = w.rising[j + 1] * (row.above[east] - V) + w.rising_below[j] * (row.below[west] - V) +
                         w.falling[j] * (row.above[west] - V) +
                         w.falling_below[j + 1] * (row.below[east] - V);
    update(c, row, j, w.inverse_mass[j + 1] * (straight + oblique));
  });
}

template <class Body>
void for_rows(Threads threads, int n, const Body& body) {
  if (threads == Threads::one) {
    for (int i = 0; i < n; ++i) body(i);
    return;
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i) body(i);
}

}  // namespace

template <class Real>
void step_identity(Threads threads, const Constants<Real>& c, int n, const Fields<Real>& old,
                   const Fields<Real>& next) {
  const Real inverse_dx2 = 1 / (c.dx * c.dx);
  for_rows(threads, n, [&](int i) { identity_row(c, inverse_dx2, n, Row<Real>(i, n, old, next)); });
}

template <class Real>
void step_conservative(Threads threads, const Constants<Real>& c, const EdgeNetwork<Real>& w,
                       const Fields<Real>& old, const Fields<Real>& next) {
  for_rows(threads, w.n,
           [&](int i) { conservative_row(c, w.n, Row<Real>(i, w.n, old, next), WeightRow<Real>(i, w)); });
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
