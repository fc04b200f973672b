// Scenes from TOML that is parsed already.
#pragma once

#include "apps/input/toml_input.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

// Puts "section.key=value" over a scene, making the section where there is none. What is wrong with it is
// added to `problems`.
void apply_override(toml::table& root, const std::string& text, Problems& problems);

// As parse_scene(). What is wrong is added to `problems`; the scene is of use only where nothing was.
solver::Scene read_tables(toml::table root, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides, Problems& problems);

}  // namespace myowave::apps
