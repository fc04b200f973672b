#include "apps/input/scene_file.hpp"

#include <sstream>

#include "apps/input/scene_checks.hpp"
#include "apps/input/scene_overrides.hpp"
#include "apps/input/scene_reader.hpp"
#include "apps/input/scene_tables.hpp"

namespace myowave::apps {
namespace {

using solver::Scene;

// From any folder the same.
void make_state_file_absolute(SceneTables& tables, const std::filesystem::path& folder) {
  auto* const initial = tables.root.get_as<toml::table>("initial");
  auto* const file = initial == nullptr ? nullptr : initial->get_as<std::string>("file");
  if (file == nullptr) return;
  const std::filesystem::path given = file->get();
  *file = std::filesystem::absolute(tables.origins.is_override(*file) ? given : folder / given).string();
}

Scene read(SceneTables tables, const std::filesystem::path& file, Problems& problems) {
  apply_preset(tables);
  ReadScene scene = read_against_schema(tables, file, problems);
  check_scene(scene);
  return std::move(scene.scene);
}

SceneTables overridden(std::string_view text, const std::filesystem::path& file,
                       const std::vector<std::string>& overrides, Problems& problems) {
  SceneTables tables{parse_toml(text, file, problems)};
  for (const std::string& one : overrides) apply_override(tables, one, problems);
  return tables;
}

}  // namespace

Scene read_tables(const toml::table& root, const std::filesystem::path& file,
                  std::span<const TableOverride> overrides, Problems& problems) {
  SceneTables tables{root};
  for (const auto& [key, value] : overrides) apply_override(tables, key, *value, problems);
  return read(std::move(tables), file, problems);
}

Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides) {
  Problems problems(file.string());
  Scene scene = read(overridden(text, file, overrides, problems), file, problems);
  problems.throw_if_any();
  return scene;
}

std::string overridden_text(std::string_view text, const std::filesystem::path& file,
                            const std::vector<std::string>& overrides) {
  Problems problems(file.string());
  SceneTables tables = overridden(text, file, overrides, problems);
  problems.throw_if_any();
  leave_to_preset(tables);
  make_state_file_absolute(tables, file.parent_path());
  std::ostringstream written;
  written << tables.root << '\n';
  return written.str();
}

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scene(toml_text(file, "scene"), file, overrides);
}

}  // namespace myowave::apps
