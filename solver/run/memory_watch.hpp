// How much memory a run takes, by Kokkos' own account of what it allocates.
#pragma once

#include <vector>

#include "solver/base/plan.hpp"

namespace myowave::solver {

// Follows the Views of the project (labels `myowave::...`), not what Kokkos keeps for itself. Counts those of
// the whole program, so that it tells of a run only where one run goes on at a time. A Kokkos tool that is
// loaded goes on to hear of everything. One watch at a time.
class MemoryWatch {
 public:
  MemoryWatch();
  ~MemoryWatch();
  MemoryWatch(const MemoryWatch&) = delete;
  MemoryWatch& operator=(const MemoryWatch&) = delete;

  // The most bytes at once in each memory space that was used since the watch began.
  std::vector<SpaceBytes> most() const;
};

}  // namespace myowave::solver
