// One explicit Euler step of the monodomain equations with active tension (Eqs 22a-c) along a row:
//   V += dt (D diffusion(V) + f(V, r)) / C_m,   r += dt r_t,   Ta += dt Ta_t,
// all three from the old state.
#pragma once

#include "kernels/base/row_loop.hpp"
#include "kernels/tissue/diffusion.hpp"

namespace myowave::tissue {

// Any cell and tension model with the functions of AlievPanfilov and ActiveTension will do: the
// model is a template parameter, so that tissue/ does not depend on one.
template <class Cell, class Tension>
struct MonodomainModel {
  using Real = decltype(Cell{}.k);
  static constexpr bool has_tension = Tension::integrated;
  Cell cell;
  Tension tension;
  Real D = 1;            // conductivity, length^2/t.u.
  Real inverse_C_m = 1;  // 1 / membrane capacitance
};

// The old state of a row and where the new one goes, counted from the same column as the stencil. r_next
// and Ta_next may be r and Ta. Without tension Ta and Ta_next are not looked at.
template <class Model>
struct NodeUpdate {
  using Real = typename Model::Real;
  Model model;
  Real dt;
  const Real* V;
  const Real* r;
  const Real* Ta;
  Real* V_next;
  Real* r_next;
  Real* Ta_next;

  KOKKOS_FORCEINLINE_FUNCTION void operator()(int j, Real diffused) const {
    const Real V_old = V[j], r_old = r[j];
    V_next[j] = V_old + dt * model.inverse_C_m * (model.D * diffused + model.cell.excitation(V_old, r_old));
    r_next[j] = r_old + dt * model.cell.recovery(V_old, r_old);
    if constexpr (Model::has_tension) {
      const Real Ta_old = Ta[j];
      Ta_next[j] = Ta_old + dt * model.tension.rate(V_old, Ta_old);
    }
  }

  KOKKOS_FORCEINLINE_FUNCTION void prefetch(int j) const {
    prefetch_to_read(r + j);
    prefetch_to_write(V_next + j);
    prefetch_to_write(r_next + j);
    if constexpr (Model::has_tension) {
      prefetch_to_read(Ta + j);
      prefetch_to_write(Ta_next + j);
    }
  }
};

// Updates columns begin <= j < end of a row in memory; those at the ends of the sheet see mirrored
// neighbours.
template <class Columns, class Row, class Update>
KOKKOS_FORCEINLINE_FUNCTION void update_row(const Columns& lanes, int begin, int end, int columns,
                                            const Row& row, const Update& update) {
  // Between 1 and 4 kB ahead it is all the same on an EPYC.
  constexpr int ahead = 2048 / sizeof(typename Update::Real);
  const int right = columns - 1;
  lanes.template each<typename Update::Real>(
      Kokkos::max(begin, 1), Kokkos::min(end, right), [=](int j) { update(j, row(j - 1, j, j + 1)); },
      [=](int j) {
        row.prefetch(j + ahead);
        update.prefetch(j + ahead);
      });
  if (begin == 0 || end == columns)
    lanes.once([=]() {
      if (begin == 0) update(0, row(1, 0, 1));
      if (end == columns) update(right, row(right - 1, right, right - 1));
    });
}

}  // namespace myowave::tissue
