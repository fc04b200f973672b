// Data of one instance on the host.
#pragma once

#include <Kokkos_Core.hpp>

namespace myowave::solver {

// The view on the host, when this instance has done its work on it; the view itself where it lies there.
// create_mirror_view_and_copy() would wait for the kernels of all instances.
template <class ExecutionSpace, class View>
auto host_copy(const ExecutionSpace& space, const View& view) {
  auto host = Kokkos::create_mirror_view(Kokkos::WithoutInitializing, view);
  Kokkos::deep_copy(space, host, view);
  space.fence("myowave::solver::host_copy");
  return host;
}

}  // namespace myowave::solver
