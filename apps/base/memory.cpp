#include "apps/base/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "solver/base/error.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/scene/grid_spacing.hpp"

namespace myowave::apps {

std::optional<std::uint64_t> free_memory() {
  std::ifstream meminfo("/proc/meminfo");
  std::string name, unit;
  for (std::uint64_t kibibytes = 0; meminfo >> name >> kibibytes; std::getline(meminfo, unit)) {
    if (name == "MemAvailable:") return kibibytes * 1024;
  }
  return std::nullopt;
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array<std::string_view, 7> units{"B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1024 && unit + 1 < units.size(); ++unit) value /= 1024;
  return unit == 0 ? fmt::format("{} B", bytes) : fmt::format("{:.1f} {}", value, units[unit]);
}

MemoryNeed memory_need(const solver::Scene& scene) {
  const solver::Plan plan = solver::make_plan(scene);
  MemoryNeed need{.device = solver::has_device_memory() ? plan.device_bytes() : 0};
  need.host = plan.bytes() - need.device;
  if (scene.initial.dx > 0) {
    const solver::GridSettings start = grid_of_start(scene);
    need.host += 3 * sizeof(double) * static_cast<std::uint64_t>(start.rows) *
                 static_cast<std::uint64_t>(start.columns);
  }
  return need;
}

int runs_that_fit(int wanted, const MemoryNeed& need, const std::optional<std::uint64_t>& free_host,
                  const std::optional<std::uint64_t>& free_device) {
  std::uint64_t fit = wanted;
  if (free_host && need.host > 0) fit = std::min(fit, *free_host / need.host);
  if (free_device && need.device > 0) fit = std::min(fit, *free_device / need.device);
  return static_cast<int>(std::max<std::uint64_t>(fit, 1));
}

void require_memory(const solver::Scene& scene) {
  // solver/run/device_memory.hpp checks the memory of a device.
  const std::uint64_t needed = memory_need(scene).host;
  const std::optional<std::uint64_t> free = free_memory();
  if (!free || needed <= *free) return;
  throw solver::InputError(
      fmt::format("scene \"{}\" ({} x {} nodes) needs {} of memory and {} are free; take a smaller grid.n, "
                  "or close other programs",
                  scene.name, scene.grid.rows, scene.grid.columns, bytes_text(needed), bytes_text(*free)));
}

}  // namespace myowave::apps
