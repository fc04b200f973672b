// States that are costly to compute, kept in the user's cache ($XDG_CACHE_HOME or ~/.cache) under
// the hash of what defines them.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "solver/base/run_output.hpp"

namespace myowave::apps {

// <cache>/myowave/<name>_<hash of the definition>.h5; empty where the user has no home.
std::filesystem::path cached_state_path(const std::string& name, const std::string& definition);

// The state in `path`; empty where there is none, or one that is damaged or of another definition.
std::optional<solver::InitialState> find_state(const std::filesystem::path& path,
                                               const std::string& definition);

// Writes beside the file and renames; makes the folder. Errors: std::runtime_error "cannot write FILE:
// reason".
void keep_state(const std::filesystem::path& path, const std::string& definition,
                const solver::InitialState& state);

// The state in `path`, else the computed one, which is then kept there. A file that is damaged or
// of another definition is computed anew. That nothing can be kept is told on stderr and is no error.
solver::InitialState cached_state(const std::filesystem::path& path, const std::string& definition,
                                  const std::function<solver::InitialState()>& compute);

}  // namespace myowave::apps
