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
void make_state_file_absolute(toml::table& root, const std::filesystem::path& folder) {
  auto* const initial = root.get_as<toml::table>("initial");
  auto* const file = initial == nullptr ? nullptr : initial->get_as<std::string>("file");
  if (file == nullptr) return;
  const std::filesystem::path given = file->get();
  *file = std::filesystem::absolute(is_override(file->source()) ? given : folder / given).string();
}

}  // namespace

Scene read_tables(toml::table root, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides, Problems& problems) {
  for (const std::string& one : overrides) apply_override(root, one, problems);
  apply_preset(root);
  ReadScene read = read_root(root, file, problems);
  check_scene(read);
  return std::move(read.scene);
}

Scene parse_scene(std::string_view text, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides) {
  Problems problems(file.string());
  Scene scene = read_tables(parse_toml(text, file, problems), file, overrides, problems);
  problems.throw_if_any();
  return scene;
}

std::string overridden_text(std::string_view text, const std::filesystem::path& file,
                            const std::vector<std::string>& overrides) {
  Problems problems(file.string());
  toml::table root = parse_toml(text, file, problems);
  for (const std::string& one : overrides) apply_override(root, one, problems);
  problems.throw_if_any();
  leave_to_preset(root);
  make_state_file_absolute(root, file.parent_path());
  std::ostringstream written;
  written << root << '\n';
  return written.str();
}

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scene(toml_text(file, "scene"), file, overrides);
}

}  // namespace myowave::apps
