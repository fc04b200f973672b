// Scene files: TOML text and `--set` overrides in, a validated solver::Scene out.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::apps {

// Reads a scene file. Each override is "section.key=value", as if it stood in the file.
// Errors: InputError with one line for each thing that is wrong, "file:line:column: message" or
// "--set section.key: message".
solver::Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

// The same for text that is at hand; `file` gives the name in messages, the scene's name and the
// folder that relative paths start from.
solver::Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides = {});

// The scene with its overrides as a text of its own, which gives the same scene in any folder. Comments of
// the text are lost. Errors: InputError for overrides that lead nowhere.
std::string overridden_text(std::string_view text, const std::filesystem::path& file,
                            const std::vector<std::string>& overrides);

}  // namespace myowave::apps
