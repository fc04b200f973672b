// Checks whether a scene fits the memory of the device, before anything is allocated there.
#pragma once

#include <cstdint>
#include <optional>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Free bytes on the device of this process. Empty if the excitation runs in the host's memory, or if the
// backend does not report them.
std::optional<std::uint64_t> free_device_memory();

// Errors: InputError that names what the scene's Views need and what is free.
void require_device_memory(const Scene&, const std::optional<std::uint64_t>& free = free_device_memory());

}  // namespace myowave::solver
