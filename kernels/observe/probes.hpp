// Values at chosen nodes of one member.
#pragma once

#include <cstdint>

#include "kernels/base/views.hpp"

namespace myowave::observe {

// record(step, n) = value(nodes(n)), of the linear index row columns + column. Small and frequent: where the
// host reaches the memory it is a plain loop.
template <class ExecutionSpace, class NodeList, class Record, class Value>
void record_values(const ExecutionSpace& space, const NodeList& nodes, const Record& record, int step,
                   const Value& value) {
  const int probes = static_cast<int>(nodes.extent(0));
  if constexpr (Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename NodeList::memory_space>::accessible) {
    space.fence("myowave::observe::record_probes");
    for (int n = 0; n < probes; ++n) record(step, n) = value(nodes(n));
  } else {
    Kokkos::parallel_for(
        "myowave::observe::record_probes", Kokkos::RangePolicy<ExecutionSpace>(space, 0, probes),
        KOKKOS_LAMBDA(int n) { record(step, n) = value(nodes(n)); });
  }
}

// record(step, n) = field at nodes(n).
//
//   view     shape                      access
//   field    (members, rows, columns)   read, member 0
//   nodes    (probes)                   read
//   record   (steps, probes)            write one row
template <class ExecutionSpace, class View, class NodeList, class Record>
void record_probes(const ExecutionSpace& space, const View& field, const NodeList& nodes,
                   const Record& record, int step) {
  const auto* values = field.data();
  record_values(
      space, nodes, record, step, KOKKOS_LAMBDA(std::int64_t node) { return values[node]; });
}

// V at the time of a state, as the model's scheme sees it; of the beats (MonodomainModel, row_update.hpp).
template <class Model>
struct SeenV {
  using Real = typename Model::Real;
  Model model;
  Real dt;

  KOKKOS_FUNCTION Real operator()(Real V, Real r) const { return Model::TimeScheme::seen(model, dt, V, r); }
};

// Before a step: record(step, n) = seen(V, r) at nodes(n), views as above.
template <class ExecutionSpace, class View, class NodeList, class Record, class Model>
void record_seen(const ExecutionSpace& space, const View& V, const View& r, const NodeList& nodes,
                 const Record& record, int step, const SeenV<Model>& seen) {
  const auto *V_values = V.data(), *r_values = r.data();
  record_values(
      space, nodes, record, step,
      KOKKOS_LAMBDA(std::int64_t node) { return seen(V_values[node], r_values[node]); });
}

// The same before every step of a launch of several (kernels/tissue/tiled_step.hpp).
//
//   view     shape              access
//   nodes    (probes)           read, row columns + column
//   record   (steps, probes)    write
template <class Model, class MemorySpace>
struct ProbeRecorder {
  using Real = typename Model::Real;
  Kokkos::View<const std::int64_t*, MemorySpace> nodes;
  Kokkos::View<Real**, Kokkos::LayoutRight, MemorySpace> record;
  SeenV<Model> seen;
  int columns;                             // of the sheet
  std::uint64_t rows = ~std::uint64_t(0);  // bit i % 64: row i may have a probe

  template <class Columns>
  KOKKOS_FUNCTION void operator()(const Columns& lanes, int m, int i, int step, int begin, int end,
                                  const Real* V, const Real* r) const {
    if (m != 0 || (rows >> (i & 63) & 1) == 0) return;
    const std::int64_t first = static_cast<std::int64_t>(i) * columns + begin;
    for (int p = 0; p < static_cast<int>(nodes.extent(0)); ++p) {
      const std::int64_t place = nodes(p) - first;
      if (place >= 0 && place < end - begin)
        lanes.once([&]() { record(step, p) = seen(V[place], r[place]); });
    }
  }
};

}  // namespace myowave::observe
