#include "solver/run/device_memory.hpp"

#include <fmt/format.h>

#include <Kokkos_Core.hpp>

#include "solver/base/error.hpp"
#include "solver/run/make_plan.hpp"

namespace myowave::solver {

std::optional<std::uint64_t> free_device_memory() {
#if defined(KOKKOS_ENABLE_CUDA)
  std::size_t free = 0, total = 0;
  if (has_device_memory() && cudaMemGetInfo(&free, &total) == cudaSuccess) return free;
#elif defined(KOKKOS_ENABLE_HIP)
  std::size_t free = 0, total = 0;
  if (has_device_memory() && hipMemGetInfo(&free, &total) == hipSuccess) return free;
#endif
  return std::nullopt;
}

void require_device_memory(const Scene& scene, const std::optional<std::uint64_t>& free) {
  if (!free) return;
  const std::uint64_t needed = make_plan(scene).device_bytes();
  if (needed <= *free) return;
  constexpr double MiB = 1 << 20;
  throw InputError(fmt::format(
      "scene \"{}\" ({} x {} nodes) needs {:.1f} MiB of the device's memory and {:.1f} MiB are free; take a "
      "smaller grid.n, accuracy.precision = \"float32\", or a device with more memory",
      scene.name, scene.grid.rows, scene.grid.columns, static_cast<double>(needed) / MiB,
      static_cast<double>(*free) / MiB));
}

}  // namespace myowave::solver
