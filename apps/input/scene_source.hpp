// What a scene was read from: enough to read the very same one again, whatever has become of the file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::apps {

struct SceneSource {
  std::filesystem::path file;
  std::string text;
  std::vector<std::string> overrides;

  // Errors: InputError, see parse_scene.
  solver::Scene scene() const;
  // From any working directory the same. Identity of a run in its checkpoints (solver/run/checkpoint.hpp).
  std::string json() const;
};

// Errors: InputError.
SceneSource read_source(const std::string& file, std::vector<std::string> overrides);

// Of what json() gave. Errors: InputError.
SceneSource source_from(const std::string& json);

}  // namespace myowave::apps
