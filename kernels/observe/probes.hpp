// Values at chosen nodes of one member.
#pragma once

#include <cstdint>

#include "kernels/base/views.hpp"
#include "kernels/tissue/grid.hpp"

namespace myowave::observe {

// record(step, n) = field at the linear index nodes(n) = row columns + column. Small and frequent:
// where the host reaches the memory it is a plain loop.
//
//   view     shape                      access
//   field    (members, rows, columns)   read, member 0
//   nodes    (probes)                   read
//   record   (steps, probes)            write one row
template <class ExecutionSpace, class View, class NodeList, class Record>
void record_probes(const ExecutionSpace& space, const View& field, const NodeList& nodes,
                   const Record& record, int step) {
  const int probes = static_cast<int>(nodes.extent(0));
  const auto* values = field.data();
  if constexpr (Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename View::memory_space>::accessible) {
    space.fence("myowave::observe::record_probes");
    for (int n = 0; n < probes; ++n) record(step, n) = values[nodes(n)];
  } else {
    Kokkos::parallel_for(
        "myowave::observe::record_probes", Kokkos::RangePolicy<ExecutionSpace>(space, 0, probes),
        KOKKOS_LAMBDA(int n) { record(step, n) = values[nodes(n)]; });
  }
}

// The same before every step of a launch of several (kernels/tissue/tiled_step.hpp).
//
//   view     shape              access
//   nodes    (probes)           read, row columns + column
//   record   (steps, probes)    write
template <class Real, class MemorySpace>
struct ProbeRecorder {
  Kokkos::View<const std::int64_t*, MemorySpace> nodes;
  Kokkos::View<Real**, Kokkos::LayoutRight, MemorySpace> record;
  int columns;                             // of the sheet
  std::uint64_t rows = ~std::uint64_t(0);  // bit i % 64: row i may have a probe

  template <class Columns>
  KOKKOS_FUNCTION void operator()(const Columns& lanes, int m, int i, int step, int begin, int end,
                                  const Real* V) const {
    if (m != 0 || (rows >> (i & 63) & 1) == 0) return;
    const std::int64_t first = static_cast<std::int64_t>(i) * columns + begin;
    for (int p = 0; p < static_cast<int>(nodes.extent(0)); ++p) {
      const std::int64_t place = nodes(p) - first;
      if (place >= 0 && place < end - begin) lanes.once([&]() { record(step, p) = V[place]; });
    }
  }

  // The host's: of the nodes outside a box, which keep their V through all steps of a launch.
  template <class View>
  void outside(const tissue::NodeBox& box, const View& V, int first_step, int steps) const {
    for (int p = 0; p < static_cast<int>(nodes.extent(0)); ++p) {
      const int i = static_cast<int>(nodes(p) / columns), j = static_cast<int>(nodes(p) % columns);
      if (box.contains(i, j)) continue;
      for (int step = first_step; step < first_step + steps; ++step) record(step, p) = V(0, i, j);
    }
  }
};

}  // namespace myowave::observe
