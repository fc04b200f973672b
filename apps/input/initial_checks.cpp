#include <fmt/format.h>

#include <array>

#include "apps/input/did_you_mean.hpp"
#include "apps/input/initial_state.hpp"
#include "apps/input/resample.hpp"
#include "apps/input/scene_checks.hpp"
#include "apps/input/schema.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

using solver::InputError;
using solver::Scene;

class InitialChecks {
 public:
  explicit InitialChecks(ReadScene& read) : read_(read) {}

  void check() {
    const Section& section = *find_section("initial");
    const solver::InitialSettings& initial = scene_.initial;
    if (!fine({"initial.type"})) return;
    const auto& types = std::get<Choice>(find_key(section, "type")->kind).names;
    const std::string_view type = types[static_cast<std::size_t>(initial.type)];
    check_unused(section, type);
    if (initial.type == solver::InitialSettings::Type::file) check_file();
    if (!sheet_known_ || !fine({"grid.dx", "initial.dx"})) return;
    if (initial.dx > 0 && !check_node_count(read_, "initial.dx", initial.dx, initial.dx)) return;
    if (initial.dx > 0 && !divides_sheet(scene_.grid, initial.dx)) {
      conflict(
          {"initial.dx"},
          fmt::format("initial.dx = {}: the sides of the sheet ({:g} and {:g} length units) are no whole "
                      "numbers of it",
                      initial.dx, (scene_.grid.columns - 1) * scene_.grid.dx,
                      (scene_.grid.rows - 1) * scene_.grid.dx));
      return;
    }
    using Type = solver::InitialSettings::Type;
    if (initial.type == Type::broken_front)
      check_inside("initial.offset", "the end of the front", initial.offset);
    if (initial.type == Type::settled_spiral &&
        check_inside("initial.core_offset", "the core", initial.core_offset)) {
      check_settled_spiral();
    }
  }

 private:
  bool fine(std::initializer_list<std::string_view> paths) const { return read_.fine(paths); }
  void conflict(std::initializer_list<std::string> paths, const std::string& message) {
    read_.conflict(paths, message);
  }

  void check_settled_spiral() {
    try {
      require_settled_spiral(scene_);
    } catch (const InputError& error) {
      const bool own_dx = grid_of_start(scene_).dx != solver::GridSettings{}.dx;
      if (own_dx)
        conflict({"initial.dx", "grid.dx"}, error.what());
      else
        conflict({"initial.core_offset"}, error.what());
    }
  }

  // A key of another type would be ignored. Where --set chose the type, the file's keys for its own
  // type are no mistake.
  void check_unused(const Section& section, std::string_view type) {
    const auto type_given = given_.find("initial.type");
    const bool type_set = type_given != given_.end() && origins_.is_override(*type_given->second);
    for (const Key& key : section.keys) {
      const auto found = given_.find(fmt::format("initial.{}", key.name));
      if (key.only_type.empty() || key.only_type == type || found == given_.end()) continue;
      if (type_set && !origins_.is_override(*found->second)) continue;
      const std::string help = key.name == "offset" && type == "settled_spiral"      ? hint("core_offset")
                               : key.name == "core_offset" && type == "broken_front" ? hint("offset")
                                                                                     : "";
      read_.problems.add(
          origins_.place(*found->second),
          fmt::format("initial.{} belongs to type = \"{}\" and has no effect with type = \"{}\"{}", key.name,
                      key.only_type, type, help));
    }
  }

  void check_file() {
    const std::string& file = scene_.initial.file;
    if (!fine({"initial.file"})) return;
    if (file.empty()) {
      conflict({"initial.type"}, "initial.file is missing: type = \"file\" needs the path of an HDF5 file");
      return;
    }
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
      conflict({"initial.file"}, fmt::format("initial.file: there is no file {}", file));
    } else if (std::filesystem::is_directory(file, error)) {
      conflict({"initial.file"}, fmt::format("initial.file: {} is a folder", file));
    }
  }

  // `offset` [columns, rows] from the middle of the sheet.
  bool check_inside(const std::string& path, std::string_view what, const std::array<int, 2>& offset) {
    if (!fine({path})) return false;
    const solver::GridSettings sheet = grid_of_start(scene_);
    const std::int64_t column = (sheet.columns - 1) / 2 + std::int64_t{offset[0]};
    const std::int64_t row = (sheet.rows - 1) / 2 + std::int64_t{offset[1]};
    if (column >= 0 && column < sheet.columns && row >= 0 && row < sheet.rows) return true;
    conflict({path}, fmt::format("{} = [{}, {}] puts {} at column {}, row {}, outside of the sheet ({})",
                                 path, offset[0], offset[1], what, column, row, sheet_text(sheet)));
    return false;
  }

  ReadScene& read_;
  Scene& scene_ = read_.scene;
  const std::map<std::string, const toml::node*>& given_ = read_.given;
  const Origins& origins_ = read_.tables.origins;
  // grid.n is no error, so that others can be compared with it.
  const bool sheet_known_ = read_.fine({"grid.n"});
};

}  // namespace

void check_initial(ReadScene& read) { InitialChecks(read).check(); }

}  // namespace myowave::apps
