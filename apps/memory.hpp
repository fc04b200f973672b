// Whether a scene fits this machine's memory, asked before anything is allocated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "solver/scene.hpp"

namespace myowave::apps {

// Bytes that can be had without swapping; empty where the system does not tell.
std::optional<std::uint64_t> free_memory();

// "1.5 GiB"
std::string bytes_text(std::uint64_t bytes);

// Errors: InputError that names what is needed and what is free.
void require_memory(const solver::Scene&);

}  // namespace myowave::apps
