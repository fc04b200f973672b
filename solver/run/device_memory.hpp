// Whether a scene fits the memory of the device, asked before anything is allocated there.
#pragma once

#include <cstdint>
#include <optional>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Bytes that are free on the device of this process. Empty where the excitation runs in the host's memory, or
// where the backend does not tell.
std::optional<std::uint64_t> free_device_memory();

// Errors: InputError that names what the scene's Views need and what is free.
void require_device_memory(const Scene&, const std::optional<std::uint64_t>& free = free_device_memory());

}  // namespace myowave::solver
