// Copies to the host that wait for one instance only.
#pragma once

#include <Kokkos_Core.hpp>

namespace myowave::solver {

// A copy of the view on the host, after this instance has finished its work on it; the view itself if it is
// on the host. create_mirror_view_and_copy() would wait for the kernels of all instances.
template <class ExecutionSpace, class View>
auto host_copy(const ExecutionSpace& space, const View& view) {
  auto host = Kokkos::create_mirror_view(Kokkos::WithoutInitializing, view);
  Kokkos::deep_copy(space, host, view);
  space.fence("myowave::solver::host_copy");
  return host;
}

}  // namespace myowave::solver
