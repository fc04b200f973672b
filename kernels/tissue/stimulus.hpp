// The stimulus current I_s of Eq 22a on a region of the grid.
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::tissue {

// Nodes inside a box and, for a disc, within a radius of its centre.
struct StimulusRegion {
  int row_begin = 0, row_end = 0, column_begin = 0, column_end = 0;  // half open, inside the grid
  double center_row = 0, center_column = 0;
  double radius2 = -1;  // node spacings squared; negative: the whole box

  KOKKOS_FUNCTION bool contains(int i, int j) const {
    if (i < row_begin || i >= row_end || j < column_begin || j >= column_end) return false;
    if (radius2 < 0) return true;
    const double di = i - center_row, dj = j - center_column;
    return di * di + dj * dj <= radius2;
  }
};

struct ActiveStimulus {
  StimulusRegion region;
  double amplitude = 0;  // I_s, 1/t.u.
};

// V += amplitude * scale on the region, for all members (V: members, rows, columns; scale: dt / C_m).
template <class ExecutionSpace, class Real>
void add_stimulus(const ExecutionSpace& space,
                  const EnsembleField<Real, typename ExecutionSpace::memory_space>& V,
                  const ActiveStimulus& stimulus, double scale) {
  const StimulusRegion region = stimulus.region;
  const Real step = Real(stimulus.amplitude * scale);
  Kokkos::parallel_for(
      "myowave::tissue::add_stimulus",
      Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<3>>(
          space, {0, region.row_begin, region.column_begin},
          {static_cast<int>(V.extent(0)), region.row_end, region.column_end}),
      KOKKOS_LAMBDA(int m, int i, int j) {
        if (region.contains(i, j)) V(m, i, j) += step;
      });
}

}  // namespace myowave::tissue
