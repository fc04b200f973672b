// Active tension from the grid to the Gauss points of the elements (paper, section 4): bilinear
// interpolation in the FD cell that holds the point.
//
//   view    shape                      unit   access
//   Ta      (members, rows, columns)   kPa    read
//   gauss   (elements, 4)              kPa    write, of one member
#pragma once

#include "kernels/elastic/kinematics.hpp"

namespace myowave::transfer {

template <class ExecutionSpace, class Real>
void tension_to_gauss(const ExecutionSpace& space, const elastic::ElementGrid& elements,
                      int cells_per_element,
                      const EnsembleField<const Real, typename ExecutionSpace::memory_space>& Ta, int member,
                      const GaussTension<typename ExecutionSpace::memory_space>& gauss) {
  Kokkos::parallel_for(
      "myowave::transfer::tension_to_gauss",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, elements.elements()), KOKKOS_LAMBDA(int e) {
        for (int q = 0; q < 4; ++q) {
          const double x = (e % elements.columns + elastic::gauss_coordinate(q % 2)) * cells_per_element;
          const double y = (e / elements.columns + elastic::gauss_coordinate(q / 2)) * cells_per_element;
          const int j = static_cast<int>(x), i = static_cast<int>(y);
          const double s = x - j, t = y - i;
          gauss(e, q) = (1 - t) * ((1 - s) * Ta(member, i, j) + s * Ta(member, i, j + 1)) +
                        t * ((1 - s) * Ta(member, i + 1, j) + s * Ta(member, i + 1, j + 1));
        }
      });
}

}  // namespace myowave::transfer
