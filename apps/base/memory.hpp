// Checks before anything is allocated that a scene fits the memory of this machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "solver/scene/scene.hpp"

namespace myowave::apps {

// Bytes that can be used without swapping; empty if the system does not report them.
std::optional<std::uint64_t> free_memory();

// Bytes that a run needs in host memory and, if the device has its own, in device memory.
struct MemoryNeed {
  std::uint64_t host = 0, device = 0;
};
MemoryNeed memory_need(const solver::Scene&);

// How many parallel runs fit if each needs at most that much: at most `wanted`, at least one.
// An unknown amount of free memory sets no bound.
int runs_that_fit(int wanted, const MemoryNeed&, const std::optional<std::uint64_t>& free_host,
                  const std::optional<std::uint64_t>& free_device);

// "1.5 GiB"
std::string bytes_text(std::uint64_t bytes);

// Errors: InputError that names what is needed and what is free.
void require_memory(const solver::Scene&);

}  // namespace myowave::apps
