// States that are costly to compute, kept in the user's cache ($XDG_CACHE_HOME or ~/.cache) under
// the hash of what defines them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "solver/run.hpp"

namespace myowave::apps {

// <cache>/myowave/<name>_<hash of the definition>.h5; empty where the user has no home.
std::filesystem::path cached_state_path(const std::string& name, const std::string& definition);

// The state in `path`, else the computed one, which is then kept there. A file that is damaged or
// of another definition is computed anew. That nothing can be kept is told on stderr and is no error.
solver::InitialState cached_state(const std::filesystem::path& path, const std::string& definition,
                                  const std::function<solver::InitialState()>& compute);

}  // namespace myowave::apps
