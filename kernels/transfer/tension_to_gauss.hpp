// Active tension from the grid to the Gauss points of the elements (paper, section 4): bilinear
// interpolation in the FD cell that holds the point.
//
//   view    shape                      unit   access
//   Ta      (members, rows, columns)   kPa    read
//   gauss   (elements, 4)              kPa    write, of one member
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"

namespace myowave::transfer {

// Coordinate of Gauss point q = 0, 1 of the two-point rule on [0, 1].
KOKKOS_INLINE_FUNCTION double gauss_coordinate(int q) {
  constexpr double half_distance = 0.28867513459481288;  // 1 / (2 sqrt 3)
  return q == 0 ? 0.5 - half_distance : 0.5 + half_distance;
}

template <class ExecutionSpace, class Real>
void tension_to_gauss(const ExecutionSpace& space, const elastic::ElementGrid& elements,
                      int cells_per_element,
                      const EnsembleField<const Real, typename ExecutionSpace::memory_space>& Ta, int member,
                      const GaussTension<typename ExecutionSpace::memory_space>& gauss) {
  Kokkos::parallel_for(
      "myowave::transfer::tension_to_gauss",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, elements.elements()), KOKKOS_LAMBDA(int e) {
        for (int q = 0; q < 4; ++q) {
          const double x = (e % elements.columns + gauss_coordinate(q % 2)) * cells_per_element;
          const double y = (e / elements.columns + gauss_coordinate(q / 2)) * cells_per_element;
          const int j = static_cast<int>(x), i = static_cast<int>(y);
          const double s = x - j, t = y - i;
          gauss(e, q) = (1 - t) * ((1 - s) * Ta(member, i, j) + s * Ta(member, i, j + 1)) +
                        t * ((1 - s) * Ta(member, i + 1, j) + s * Ta(member, i + 1, j + 1));
        }
      });
}

}  // namespace myowave::transfer
