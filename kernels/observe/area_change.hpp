// Areas of the deformed elements: exact for bilinear quadrilaterals (shoelace of the four nodes).
#pragma once

#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"

namespace myowave::observe {

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION double element_area(const elastic::ElementGrid& elements, const Nodes<MemorySpace>& x,
                                           int e) {
  const int a = elements.corner(e, 0), b = elements.corner(e, 1), c = elements.corner(e, 3),
            d = elements.corner(e, 2);
  return 0.5 * ((x(c, 0) - x(a, 0)) * (x(d, 1) - x(b, 1)) - (x(d, 0) - x(b, 0)) * (x(c, 1) - x(a, 1)));
}

// areas (elements): length^2, write.
template <class ExecutionSpace>
void element_areas(const ExecutionSpace& space, const elastic::ElementGrid& elements,
                   const Nodes<typename ExecutionSpace::memory_space>& nodes,
                   const Kokkos::View<double*, typename ExecutionSpace::memory_space>& areas) {
  Kokkos::parallel_for(
      "myowave::observe::element_areas", Kokkos::RangePolicy<ExecutionSpace>(space, 0, elements.elements()),
      KOKKOS_LAMBDA(int e) { areas(e) = element_area(elements, nodes, e); });
}

}  // namespace myowave::observe
