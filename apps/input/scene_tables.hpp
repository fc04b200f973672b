// Scenes from TOML that is parsed already.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "apps/input/toml_input.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

// A value for "section.key" in place of the scene's own.
struct TableOverride {
  std::string key;
  const toml::node* value;
};

// As parse_scene(), with the overrides put over the tables in their order. What is wrong is added to
// `problems`, under the override's key where an override is to blame; the scene is of use only where nothing
// was.
solver::Scene read_tables(const toml::table& root, const std::filesystem::path& file,
                          std::span<const TableOverride> overrides, Problems& problems);

}  // namespace myowave::apps
