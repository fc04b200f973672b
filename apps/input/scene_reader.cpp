#include "apps/input/scene_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "apps/input/did_you_mean.hpp"
#include "apps/input/schema.hpp"

namespace myowave::apps {
namespace {

using solver::Scene;

std::optional<double> number_in(const toml::node& node, const Range& range) {
  if (!node.is_number()) return std::nullopt;
  const double value = *node.value<double>();
  return std::isfinite(value) && range.contains(value) ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> integer_in(const toml::node& node, const Range& range) {
  const auto* integer = node.as_integer();
  return integer != nullptr && range.contains(static_cast<double>(integer->get()))
             ? std::optional(integer->get())
             : std::nullopt;
}

constexpr Range int_range{.low = std::numeric_limits<int>::min(), .high = std::numeric_limits<int>::max()};

std::optional<std::array<int, 2>> int_pair(const toml::node* node, const Range& range = int_range) {
  const auto* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr || array->size() != 2) return std::nullopt;
  const auto first = integer_in(*array->get(0), range), second = integer_in(*array->get(1), range);
  if (!first || !second) return std::nullopt;
  return std::array{static_cast<int>(*first), static_cast<int>(*second)};
}

class SceneReader {
 public:
  SceneReader(const SceneTables& tables, const std::filesystem::path& file, Problems& problems)
      : folder_(file.parent_path()), read_{.tables = tables, .problems = problems} {
    scene_.name = file.stem().string();
  }

  // ---- tables -------------------------------------------------------------------------------

  ReadScene read() {
    for (const auto& [name, node] : root_) {
      if (const Section* section = find_section(name.str());
          section == nullptr || section->name.find('.') != std::string_view::npos) {
        unknown_section(name);
      }
    }
    for (const Section& section : schema()) {
      if (section.name == "initial.precondition") continue;  // after [tension], whose values it starts from
      const toml::node* node = root_.get(section.name);
      if (node != nullptr) read_section(section, *node);
    }
    if (const toml::node* node = root_.at_path("initial.precondition").node()) {
      read_section(*find_section("initial.precondition"), *node);
    }
    return std::move(read_);
  }

 private:
  void unknown_section(const toml::key& name) {
    std::vector<std::string_view> names;
    for (const Section& section : schema()) {
      if (find_key(section, name.str()) != nullptr && section.inherits.empty()) {
        problems_.add(name.source(),
                      fmt::format("\"{0}\" stands outside of its section; did you mean \"{1}.{0}\"?",
                                  printable(name.str()), section.name));
        return;
      }
      if (section.name.find('.') == std::string_view::npos) names.push_back(section.name);
    }
    problems_.add(name.source(), fmt::format("unknown section \"{}\"{}", printable(name.str()),
                                             hint(did_you_mean(name.str(), names))));
  }

  void read_section(const Section& section, const toml::node& node) {
    const std::string name(section.name);
    given_[name] = &node;
    if (const auto* table = node.as_table()) {
      read_element(section, *table, name);
      return;
    }
    const auto* array = node.as_array();
    if (!section.repeated || array == nullptr) {
      bad(name, node, section.repeated ? "a table or an array of tables" : "a table");
      return;
    }
    for (std::size_t i = 0; i < array->size(); ++i) {
      const std::string path = fmt::format("{}.{}", name, i);
      given_[path] = array->get(i);
      if (const auto* table = array->get(i)->as_table()) {
        read_element(section, *table, path);
      } else {
        bad(path, *array->get(i), "a table");
      }
    }
  }

  void read_element(const Section& section, const toml::table& table, const std::string& path) {
    if (section.name == "stimulus") {
      solver::Stimulus stimulus;
      read_keys(section, table, path, Target(scene_, stimulus));
      // A period asks for more than one pulse.
      if (!table.contains("count") && stimulus.period > 0) stimulus.count = -1;
      scene_.stimuli.push_back(stimulus);
      read_.stimulus_paths.push_back(path);
    } else if (section.name == "initial.precondition") {
      solver::Precondition precondition;
      read_keys(section, table, path, Target(scene_, precondition));
      scene_.initial.preconditions.push_back(precondition);
      read_.precondition_paths.push_back(path);
    } else if (section.name == "mechanics") {
      scene_.mechanics.emplace();
      read_keys(section, table, path, Target(scene_));
      if (table["on"].value<bool>() == false) scene_.mechanics.reset();
    } else {
      read_keys(section, table, path, Target(scene_));
    }
  }

  void read_keys(const Section& section, const toml::table& table, const std::string& path, Target target) {
    for (const auto& [name, node] : table) {
      if (find_key(section, name.str()) == nullptr &&
          find_section(path + "." + std::string(name.str())) == nullptr) {
        unknown_key(section, name, table, path);
      }
    }
    for (std::string_view other : section.inherits) {
      const Section& whole = *find_section(other);
      const toml::table* scene_table = root_[other].as_table();
      for (const Key& key : whole.keys) {
        // What the table does not name is as in the scene.
        if (const toml::node* node = table.get(key.name)) {
          read_value(key, *node, fmt::format("{}.{}", path, key.name), target);
        } else if (const toml::node* own = scene_table == nullptr ? nullptr : scene_table->get(key.name)) {
          read_value(key, *own, fmt::format("{}.{}", other, key.name), target);
        }
      }
    }
    for (const Key& key : section.keys) {
      if (const toml::node* node = table.get(key.name)) {
        read_value(key, *node, fmt::format("{}.{}", path, key.name), target);
      } else if (key.required) {
        problems_.add(origins_.place(table),
                      fmt::format("{}.{} is missing: {}", path, key.name, requirement_text(key)));
      }
    }
  }

  void unknown_key(const Section& section, const toml::key& name, const toml::table& table,
                   const std::string& path) {
    std::vector<std::string_view> names;
    for (const Key& key : section.keys) names.push_back(key.name);
    for (std::string_view other : section.inherits) {
      for (const Key& key : find_section(other)->keys) names.push_back(key.name);
    }
    if (section.name == "initial") names.push_back("precondition");
    std::string help = hint(did_you_mean(name.str(), names));
    if (help.empty()) {
      for (const Section& other : schema()) {
        if (other.inherits.empty() && find_key(other, name.str()) != nullptr) {
          help = fmt::format("; it is a key of [{}]", other.name);
          break;
        }
      }
    }
    if (help.empty()) help = fmt::format("; keys: {}", fmt::join(names, ", "));
    problems_.add(origins_.place(name, table),
                  fmt::format("unknown key \"{}\" in [{}]{}", printable(name.str()), path, help));
  }

  // ---- values -------------------------------------------------------------------------------

  void bad(const std::string& path, const toml::node& node, const std::string& required,
           const std::string& help = "") {
    wrong_.insert(path);
    problems_.add(origins_.place(node),
                  fmt::format("{} must be {}, not {}{}", path, required, shown(node), help));
  }

  void read_value(const Key& key, const toml::node& node, const std::string& path, Target& target) {
    given_[path] = &node;
    const auto read = [&](const auto& kind) { return set(kind, node, path, target); };
    if (std::visit(read, key.kind) || wrong_.contains(path)) return;
    std::string help;
    const auto* text = node.as_string();
    if (const auto* choice = std::get_if<Choice>(&key.kind); choice != nullptr && text != nullptr) {
      help = hint(did_you_mean(text->get(), choice->names));
    }
    bad(path, node, requirement_text(key), help);
  }

  // Each returns false where the value is not what its kind asks for.
  bool set(const Number& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = number_in(node, kind.range);
    if (value) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Integer& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = integer_in(node, kind.range);
    if (value) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Flag& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = node.value_exact<bool>();
    if (value && kind.set) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Choice& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = node.value_exact<std::string_view>();
    const auto found = value ? std::ranges::find(kind.names, *value) : kind.names.end();
    if (found == kind.names.end()) return false;
    kind.set(target, found - kind.names.begin());
    return true;
  }

  bool set(const Choices& kind, const toml::node& node, const std::string& path, Target& target) {
    const auto* array = node.as_array();
    if (array == nullptr) return false;
    std::vector<bool> chosen(kind.names.size());
    for (const toml::node& element : *array) {
      const auto name = element.value_exact<std::string_view>();
      const auto found = name ? std::ranges::find(kind.names, *name) : kind.names.end();
      const bool known = found != kind.names.end();
      if (known && !chosen[found - kind.names.begin()]) {
        chosen[found - kind.names.begin()] = true;
        continue;
      }
      bad(path, element, fmt::format("a {}, each at most once", type_text(kind)),
          name && !known ? hint(did_you_mean(*name, kind.names)) : "");
      return false;
    }
    kind.set(target, chosen);
    return true;
  }

  bool set(const Path& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = node.value_exact<std::string>();
    if (!value || value->empty()) return false;
    const std::filesystem::path given(*value);
    kind.set(target, (origins_.is_override(node) ? given : folder_ / given).string());
    return true;
  }

  bool set(const Pair& kind, const toml::node& node, const std::string&, Target& target) {
    const auto value = int_pair(&node, kind.range);
    if (value) kind.set(target, *value);
    return value.has_value();
  }

  bool set(const Size& kind, const toml::node& node, const std::string&, Target& target) {
    std::optional<std::array<int, 2>> size = int_pair(&node, kind.range);
    if (const auto side = integer_in(node, kind.range))
      size = std::array{static_cast<int>(*side), static_cast<int>(*side)};
    if (size) std::tie(target.scene.grid.rows, target.scene.grid.columns) = std::tuple_cat(*size);
    return size.has_value();
  }

  bool set(const Probes&, const toml::node& node, const std::string&, Target& target) {
    const auto* array = node.as_array();
    if (array == nullptr) return false;
    target.scene.output.probes.clear();
    for (const toml::node& element : *array) {
      const auto probe = int_pair(&element);
      if (!probe) return false;
      target.scene.output.probes.push_back(*probe);
    }
    return true;
  }

  bool set(const Region&, const toml::node& node, const std::string& path, Target& target) {
    using Shape = solver::Stimulus::Shape;
    solver::Stimulus& stimulus = *target.stimulus;
    if (node.value_exact<std::string_view>() == "all") return true;
    const auto* table = node.as_table();
    if (table == nullptr || table->empty()) return false;
    const std::vector<std::string_view> names{"center", "radius", "columns", "rows"};
    bool known = true;
    for (const auto& [name, value] : *table) {
      if (std::ranges::find(names, name.str()) != names.end()) continue;
      known = false;
      wrong_.insert(path);
      problems_.add(origins_.place(name, *table),
                    fmt::format("unknown key \"{}\" in {}{}", printable(name.str()), path,
                                hint(did_you_mean(name.str(), names))));
    }
    if (!known) return false;
    const bool is_disc = table->contains("center") || table->contains("radius");
    const bool is_block = table->contains("columns") || table->contains("rows");
    if (is_disc == is_block) return false;
    if (is_disc) return set_disc(*table, path, stimulus);
    stimulus.shape = Shape::block;
    // Read both, so that the errors of both are reported.
    const bool columns = set_side(*table, "columns", path, scene_.grid.columns, stimulus.columns);
    const bool rows = set_side(*table, "rows", path, scene_.grid.rows, stimulus.rows);
    return columns && rows;
  }

  bool set_disc(const toml::table& table, const std::string& path, solver::Stimulus& stimulus) {
    stimulus.shape = solver::Stimulus::Shape::disc;
    const toml::node* center = table.get("center");
    const toml::node* radius = table.get("radius");
    if (center == nullptr || radius == nullptr) return false;
    const auto* array = center->as_array();
    const auto x = array != nullptr && array->size() == 2 ? number_in(*array->get(0), {}) : std::nullopt;
    const auto y = x ? number_in(*array->get(1), {}) : std::nullopt;
    if (!y) bad(path + ".center", *center, "[column, row], two numbers");
    const auto r = number_in(*radius, {.low = 0});
    if (!r) bad(path + ".radius", *radius, "a number >= 0 (node spacings)");
    if (!y || !r) {
      wrong_.insert(path);
      return false;
    }
    stimulus.center = {*x, *y};
    stimulus.radius = *r;
    return true;
  }

  // First and last node of one side of a block; the whole side where it is not named.
  bool set_side(const toml::table& table, std::string_view name, const std::string& path, int nodes,
                std::array<int, 2>& side) {
    const toml::node* node = table.get(name);
    side = {0, nodes - 1};
    if (node == nullptr) return true;
    const auto value = int_pair(node);
    if (!value) {
      bad(fmt::format("{}.{}", path, name), *node, "[first, last], two integers");
      wrong_.insert(path);
      return false;
    }
    side = *value;
    return true;
  }

  std::filesystem::path folder_;
  ReadScene read_;
  const toml::table& root_ = read_.tables.root;
  const Origins& origins_ = read_.tables.origins;
  Problems& problems_ = read_.problems;
  Scene& scene_ = read_.scene;
  std::map<std::string, const toml::node*>& given_ = read_.given;
  std::set<std::string>& wrong_ = read_.wrong;
};

}  // namespace

bool ReadScene::fine(std::initializer_list<std::string_view> paths) const {
  return std::ranges::none_of(paths,
                              [&](std::string_view path) { return wrong.contains(std::string(path)); });
}

void ReadScene::conflict(std::initializer_list<std::string> paths, const std::string& message) {
  std::optional<toml::source_region> place;
  for (const std::string& path : paths) {
    const auto found = given.find(path);
    if (found == given.end()) continue;
    const toml::source_region here = place_of(*found->second);
    if (!place || (is_override(here) && !is_override(*place))) place = here;
  }
  problems.add(place.value_or(toml::source_region{}), message);
}

toml::source_region ReadScene::place_of(const toml::node& node) const {
  const bool of_preset = tables.origins.is_from_preset(node);
  return tables.origins.place(of_preset ? *tables.root.at_path(preset_key).node() : node);
}

ReadScene read_against_schema(const SceneTables& tables, const std::filesystem::path& file,
                              Problems& problems) {
  return SceneReader(tables, file, problems).read();
}

}  // namespace myowave::apps
