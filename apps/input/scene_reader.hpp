// Tables of a scene against the schema: each key into its place in a Scene. What several keys must agree on
// is checked afterwards, apps/input/scene_checks.hpp.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "apps/input/scene_overrides.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

// A scene with the places that its values come from.
struct ReadScene {
  const SceneTables& tables;
  Problems& problems;
  solver::Scene scene{};
  std::map<std::string, const toml::node*> given{};  // by path: "grid.n", "stimulus.0", ...
  std::set<std::string> wrong{};                     // paths already reported
  std::vector<std::string> stimulus_paths{}, precondition_paths{};

  // None of the paths was reported.
  bool fine(std::initializer_list<std::string_view> paths) const;
  // Reports at the first of the paths that the scene gives, one of --set before one of the file.
  void conflict(std::initializer_list<std::string> paths, const std::string& message);
  // Of a value where problems have it; of a preset's value the place of the preset.
  toml::source_region place_of(const toml::node&) const;
};

// `tables` and `problems` must outlive the result. Paths in the tables are relative to the file's folder.
ReadScene read_against_schema(const SceneTables& tables, const std::filesystem::path& file,
                              Problems& problems);

}  // namespace myowave::apps
