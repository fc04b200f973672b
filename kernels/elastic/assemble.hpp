// Launchers over the elements: energy, linearization, and their gathers to nodes and matrix slots.
//
// Elements write arrays of their own; every node and every matrix slot then sums its contributions
// in a fixed order. No atomics: the bits do not depend on the number of threads.
//
// | view             | shape          | unit         |                                                   |
// |------------------|----------------|--------------|---------------------------------------------------|
// | nodes            | (nodes, 2)     | length       | positions                                         |
// | Ta               | (elements, 4)  | kPa          | tension at the Gauss points                       |
// | energy           | (elements)     | kPa x area   | Pi of the element                                 |
// | element_residual | (elements, 8)  | kPa x length | dof 2 c + i                                       |
// | element_tangent  | (elements, 36) | kPa          | lower triangle by rows                            |
// | residual         | (nodes, 2)     | kPa x length | dPi/dx, also at held nodes: what holds them       |
// | slot_begin       | (slots + 1)    |              | sources of slot s: slot_begin(s) to slot_begin(s+1) |
// | slot_source      | (sources)      |              | 36 element + tangent entry                        |
// | values           | (slots)        | kPa          | lower triangle of K in compressed rows            |
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/base/views.hpp"
#include "kernels/elastic/element.hpp"
#include "kernels/elastic/element_grid.hpp"

namespace myowave::elastic {

// Layouts follow the backend: an element's numbers together on a processor, interleaved on a GPU.
template <class MemorySpace>
using ElementResidual = Kokkos::View<double* [element_dofs], MemorySpace>;
template <class MemorySpace>
using ElementTangent = Kokkos::View<double* [tangent_entries], MemorySpace>;
template <class MemorySpace>
using Numbers = Kokkos::View<double*, MemorySpace>;
template <class MemorySpace>
using Indices = Kokkos::View<int*, MemorySpace>;

namespace detail {

template <class Space>
Kokkos::RangePolicy<Space> range(const Space& space, int n) {
  return {space, 0, n};
}

template <class TensionView>
KOKKOS_INLINE_FUNCTION void load_tension(const TensionView& Ta, int e, double (&out)[gauss_points]) {
  for (int q = 0; q < gauss_points; ++q) out[q] = Ta(e, q);
}

}  // namespace detail

// The sheet stretched uniformly about its middle node, which stays: undeformed at stretch = 1.
template <class Space>
void place_uniform(const Space& space, const ElementGrid& grid, double stretch,
                   const Nodes<typename Space::memory_space>& nodes) {
  Kokkos::parallel_for(
      "myowave::elastic::place_uniform", detail::range(space, grid.nodes()), KOKKOS_LAMBDA(int n) {
        const int I = n / (grid.columns + 1), J = n % (grid.columns + 1);
        nodes(n, 0) = J * grid.h + (stretch - 1) * ((J - grid.columns / 2) * grid.h);
        nodes(n, 1) = I * grid.h + (stretch - 1) * ((I - grid.rows / 2) * grid.h);
      });
}

// Turns the sheet by 180 degrees about node `center`.
template <class Space>
void turn_around(const Space& space, int center, const Nodes<typename Space::memory_space>& nodes) {
  Kokkos::parallel_for(
      "myowave::elastic::turn_around", detail::range(space, static_cast<int>(nodes.extent(0))),
      KOKKOS_LAMBDA(int n) {
        if (n == center) return;
        nodes(n, 0) = 2 * nodes(center, 0) - nodes(n, 0);
        nodes(n, 1) = 2 * nodes(center, 1) - nodes(n, 1);
      });
}

// moved = nodes + length * direction.
template <class Space>
void move_nodes(const Space& space, const Nodes<typename Space::memory_space>& nodes,
                const Nodes<typename Space::memory_space>& direction, double length,
                const Nodes<typename Space::memory_space>& moved) {
  Kokkos::parallel_for(
      "myowave::elastic::move_nodes", detail::range(space, static_cast<int>(nodes.extent(0))),
      KOKKOS_LAMBDA(int n) {
        moved(n, 0) = nodes(n, 0) + length * direction(n, 0);
        moved(n, 1) = nodes(n, 1) + length * direction(n, 1);
      });
}

// mixed = (1 - fraction) from + fraction to.
template <class Space>
void mix_tension(const Space& space, const GaussTension<typename Space::memory_space>& from,
                 const GaussTension<typename Space::memory_space>& to, double fraction,
                 const GaussTension<typename Space::memory_space>& mixed) {
  Kokkos::parallel_for(
      "myowave::elastic::mix_tension", detail::range(space, static_cast<int>(from.extent(0))),
      KOKKOS_LAMBDA(int e) {
        for (int q = 0; q < gauss_points; ++q)
          mixed(e, q) = (1 - fraction) * from(e, q) + fraction * to(e, q);
      });
}

// Writes the energy of every element and returns the smallest corner J. An element with a corner
// J <= 0, or with positions that are not numbers, has no energy: not-a-number marks it.
template <class Space>
double element_energies(const Space& space, const Membrane& membrane, const ElementGrid& grid,
                        const Nodes<typename Space::memory_space>& nodes,
                        const GaussTension<typename Space::memory_space>& Ta,
                        const Numbers<typename Space::memory_space>& energy) {
  double min_J = 0;
  Kokkos::parallel_reduce(
      "myowave::elastic::element_energies", detail::range(space, grid.elements()),
      KOKKOS_LAMBDA(int e, double& smallest) {
        const ElementNodes element = element_nodes(grid, nodes, e);
        const double J = min_corner_J(element, grid.h);
        double tension[gauss_points];
        detail::load_tension(Ta, e, tension);
        energy(e) = J > 0 ? element_energy(membrane, element, tension, grid.h)
                          : Kokkos::Experimental::quiet_NaN_v<double>;
        if (J < smallest) smallest = J;
      },
      Kokkos::Min<double>(min_J));
  return min_J;
}

template <class Space>
void linearize_elements(const Space& space, const Membrane& membrane, const ElementGrid& grid,
                        const Nodes<typename Space::memory_space>& nodes,
                        const GaussTension<typename Space::memory_space>& Ta,
                        const ElementResidual<typename Space::memory_space>& element_residual,
                        const ElementTangent<typename Space::memory_space>& element_tangent) {
  Kokkos::parallel_for(
      "myowave::elastic::linearize_elements", detail::range(space, grid.elements()), KOKKOS_LAMBDA(int e) {
        double tension[gauss_points];
        detail::load_tension(Ta, e, tension);
        const ElementLinearization element =
            linearize_element(membrane, element_nodes(grid, nodes, e), tension, grid.h);
        for (int a = 0; a < element_dofs; ++a) element_residual(e, a) = element.R[a];
        for (int k = 0; k < tangent_entries; ++k) element_tangent(e, k) = element.K[k];
      });
}

// Sums the residual of the up to four elements at each node.
template <class Space>
void gather_residual(const Space& space, const ElementGrid& grid,
                     const ElementResidual<typename Space::memory_space>& element_residual,
                     const Nodes<typename Space::memory_space>& residual) {
  Kokkos::parallel_for(
      "myowave::elastic::gather_residual", detail::range(space, grid.nodes()), KOKKOS_LAMBDA(int n) {
        const int I = n / (grid.columns + 1), J = n % (grid.columns + 1);
        double r1 = 0, r2 = 0;
        for (int c = corners - 1; c >= 0; --c) {
          const int row = I - c / 2, column = J - c % 2;  // the element whose corner c is this node
          if (row < 0 || row >= grid.rows || column < 0 || column >= grid.columns) continue;
          const int e = row * grid.columns + column;
          r1 += element_residual(e, 2 * c);
          r2 += element_residual(e, 2 * c + 1);
        }
        residual(n, 0) = r1;
        residual(n, 1) = r2;
      });
}

template <class Space>
void gather_tangent(const Space& space, const Indices<typename Space::memory_space>& slot_begin,
                    const Indices<typename Space::memory_space>& slot_source,
                    const ElementTangent<typename Space::memory_space>& element_tangent,
                    const Numbers<typename Space::memory_space>& values) {
  Kokkos::parallel_for(
      "myowave::elastic::gather_tangent", detail::range(space, static_cast<int>(values.extent(0))),
      KOKKOS_LAMBDA(int s) {
        double sum = 0;
        for (int k = slot_begin(s); k < slot_begin(s + 1); ++k) {
          sum += element_tangent(slot_source(k) / tangent_entries, slot_source(k) % tangent_entries);
        }
        values(s) = sum;
      });
}

}  // namespace myowave::elastic
