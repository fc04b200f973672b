// Measures the memory of a run from the allocations that Kokkos reports.
#pragma once

#include <vector>

#include "solver/base/plan.hpp"

namespace myowave::solver {

// Counts the Views of the project (labels `myowave::...`), not those of Kokkos itself. It counts those of the
// whole program, so it describes a run only while one run is in progress. A loaded Kokkos tool still receives
// all events. One watch at a time.
class MemoryWatch {
 public:
  MemoryWatch();
  ~MemoryWatch();
  MemoryWatch(const MemoryWatch&) = delete;
  MemoryWatch& operator=(const MemoryWatch&) = delete;

  // The most bytes at once in each memory space that was used since the watch started.
  std::vector<SpaceBytes> most() const;
};

}  // namespace myowave::solver
