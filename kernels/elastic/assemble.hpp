// Launchers over the elements: energy, linearization, and their gathers to nodes and matrix slots.
//
// Every element writes its own entries; every node then sums its contributions in a fixed order. There are
// no atomics, so results are bitwise identical for any number of threads.
//
//   view            shape           unit
//   nodes           (nodes, 2)      length              positions
//   Ta              (elements, 4)   kPa                 tension at the Gauss points
//   energy          (2, elements)   kPa x area, -       Pi and smallest corner J of the element
//   element         (44, places)    kPa x length, kPa   residual, dof 2 c + i; tangent, its lower half
//   residual        (nodes, 2)      kPa x length        dPi/dx; at fixed nodes the reaction force
//   nodal_tangent   (19, nodes)     kPa                 K of the node's two rows, see NodalTangent
//   slot_source     (slots)         -                   entry nodes + node in nodal_tangent
//   values          (slots)         kPa                 lower triangle of K in compressed rows
//
// Element (I, J) is at place node(I, J) + columns + 2. The elements around node n are then at n, n + 1,
// n + columns + 1 and n + columns + 2. Places without an element are zero.
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/base/views.hpp"
#include "kernels/elastic/element.hpp"
#include "kernels/elastic/element_grid.hpp"
#include "kernels/elastic/element_loop.hpp"

namespace myowave::elastic {

// Rows of neighbouring elements or nodes: vector lanes on a processor, coalesced on a GPU.
template <class MemorySpace>
using Rows = Kokkos::View<double**, Kokkos::LayoutRight, MemorySpace>;
template <class MemorySpace>
using Numbers = Kokkos::View<double*, MemorySpace>;
template <class MemorySpace>
using Indices = Kokkos::View<int*, MemorySpace>;

inline constexpr int linearization_entries = element_dofs + tangent_entries;
constexpr int places(const ElementGrid& grid) { return grid.nodes() + grid.columns + 2; }

// K of a node with the four nodes before it: entry 4 k + 2 i + j for its component i and component j of
// neighbour k. Then K of the node with itself: 11, 21, 22.
struct NodalTangent {
  static constexpr int neighbours = 4;
  static constexpr int self = 4 * neighbours;
  static constexpr int entries = self + 3;
  // Neighbour k is node (I + row(k), J + column(k)).
  static constexpr int row(int k) { return k < 3 ? -1 : 0; }
  static constexpr int column(int k) { return k < 3 ? k - 1 : -1; }
};

namespace detail {

template <class Space>
Kokkos::RangePolicy<Space> range(const Space& space, int n) {
  return {space, 0, n};
}

}  // namespace detail

// Stretches the sheet uniformly about its middle node, which does not move; stretch = 1: undeformed.
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

// Whether both are equal at every Gauss point; NaN equals nothing.
template <class Space>
bool same_tension(const Space& space, const GaussTension<typename Space::memory_space>& one,
                  const GaussTension<typename Space::memory_space>& other) {
  int different = 0;
  Kokkos::parallel_reduce(
      "myowave::elastic::same_tension", detail::range(space, static_cast<int>(one.extent(0))),
      KOKKOS_LAMBDA(int e, int& count) {
        for (int q = 0; q < gauss_points; ++q)
          if (!(one(e, q) == other(e, q))) ++count;
      },
      different);
  return different == 0;
}

// Writes the energy of every element and its smallest corner J. The energy is meaningless if that J is not
// positive.
template <class MemorySpace>
struct ElementEnergies {
  Membrane membrane;
  ElementGrid grid;
  Nodes<MemorySpace> nodes;
  GaussTension<MemorySpace> Ta;
  Rows<MemorySpace> energy;

  KOKKOS_FORCEINLINE_FUNCTION void operator()(int I, int J) const {
    const int e = grid.element(I, J);
    const ElementNodes element = element_nodes(grid, nodes, I, J);
    const double tension[gauss_points] = {Ta(e, 0), Ta(e, 1), Ta(e, 2), Ta(e, 3)};
    energy(0, e) = element_energy(membrane, element, tension, grid.h);
    energy(1, e) = min_corner_J(element, grid.h);
  }
};

template <class Space>
void element_energies(const Space& space, const Membrane& membrane, const ElementGrid& grid,
                      const Nodes<typename Space::memory_space>& nodes,
                      const GaussTension<typename Space::memory_space>& Ta,
                      const Rows<typename Space::memory_space>& energy) {
  for_columns_of_rows("myowave::elastic::element_energies", space, grid.rows, grid.columns,
                      ElementEnergies<typename Space::memory_space>{membrane, grid, nodes, Ta, energy});
}

template <class MemorySpace>
struct LinearizeElements {
  Membrane membrane;
  ElementGrid grid;
  Nodes<MemorySpace> nodes;
  GaussTension<MemorySpace> Ta;
  Rows<MemorySpace> element;

  KOKKOS_FORCEINLINE_FUNCTION void operator()(int I, int J) const {
    const int e = grid.element(I, J), place = grid.node(I, J) + grid.columns + 2;
    const double tension[gauss_points] = {Ta(e, 0), Ta(e, 1), Ta(e, 2), Ta(e, 3)};
    const ElementLinearization found =
        linearize_element(membrane, element_nodes(grid, nodes, I, J), tension, grid.h);
#pragma GCC unroll 8
    for (int a = 0; a < element_dofs; ++a) element(a, place) = found.R[a];
#pragma GCC unroll 36
    for (int k = 0; k < tangent_entries; ++k) element(element_dofs + k, place) = found.K[k];
  }
};

template <class Space>
void linearize_elements(const Space& space, const Membrane& membrane, const ElementGrid& grid,
                        const Nodes<typename Space::memory_space>& nodes,
                        const GaussTension<typename Space::memory_space>& Ta,
                        const Rows<typename Space::memory_space>& element) {
  for_columns_of_rows("myowave::elastic::linearize_elements", space, grid.rows, grid.columns,
                      LinearizeElements<typename Space::memory_space>{membrane, grid, nodes, Ta, element});
}

// Sums residual and tangent of the elements around each node (at most four), in the order of the elements.
template <class MemorySpace>
struct GatherNodes {
  ElementGrid grid;
  Rows<MemorySpace> element;
  Nodes<MemorySpace> residual;
  Rows<MemorySpace> nodal_tangent;

  // The element with node n as its corner c.
  KOKKOS_FORCEINLINE_FUNCTION int place(int n, int c) const {
    return n + (c < 2 ? grid.columns + 1 : 0) + (c % 2 == 0 ? 1 : 0);
  }
  KOKKOS_FORCEINLINE_FUNCTION double R(int n, int c, int i) const { return element(2 * c + i, place(n, c)); }
  KOKKOS_FORCEINLINE_FUNCTION double K(int n, int c, int i, int b, int j) const {
    return element(element_dofs + tangent_entry(2 * c + i, 2 * b + j), place(n, c));
  }

  KOKKOS_FORCEINLINE_FUNCTION void operator()(int I, int J) const {
    const int n = grid.node(I, J);
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      residual(n, i) = R(n, 3, i) + R(n, 2, i) + R(n, 1, i) + R(n, 0, i);
#pragma GCC unroll 2
      for (int j = 0; j < 2; ++j) {
        nodal_tangent(2 * i + j, n) = K(n, 3, i, 0, j);
        nodal_tangent(4 + 2 * i + j, n) = K(n, 3, i, 1, j) + K(n, 2, i, 0, j);
        nodal_tangent(8 + 2 * i + j, n) = K(n, 2, i, 1, j);
        nodal_tangent(12 + 2 * i + j, n) = K(n, 3, i, 2, j) + K(n, 1, i, 0, j);
        if (j <= i)
          nodal_tangent(NodalTangent::self + i + j, n) =
              K(n, 3, i, 3, j) + K(n, 2, i, 2, j) + K(n, 1, i, 1, j) + K(n, 0, i, 0, j);
      }
    }
  }
};

template <class Space>
void gather_nodes(const Space& space, const ElementGrid& grid,
                  const Rows<typename Space::memory_space>& element,
                  const Nodes<typename Space::memory_space>& residual,
                  const Rows<typename Space::memory_space>& nodal_tangent) {
  for_columns_of_rows("myowave::elastic::gather_nodes", space, grid.rows + 1, grid.columns + 1,
                      GatherNodes<typename Space::memory_space>{grid, element, residual, nodal_tangent});
}

template <class Space>
void gather_tangent(const Space& space, const Indices<typename Space::memory_space>& slot_source,
                    const Rows<typename Space::memory_space>& nodal_tangent,
                    const Numbers<typename Space::memory_space>& values) {
  const double* const source = nodal_tangent.data();
  Kokkos::parallel_for(
      "myowave::elastic::gather_tangent", detail::range(space, static_cast<int>(values.extent(0))),
      KOKKOS_LAMBDA(int s) { values(s) = source[slot_source(s)]; });
}

}  // namespace myowave::elastic
