// Scenes from TOML that is parsed already.
#pragma once

#include "apps/input/toml_input.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

// As parse_scene(). What is wrong is added to `problems`; the scene is of use only where nothing was.
solver::Scene read_tables(toml::table root, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides, Problems& problems);

}  // namespace myowave::apps
