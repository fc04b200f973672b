#include "apps/input/scene_overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "apps/input/presets.hpp"
#include "apps/input/schema.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

using solver::InputError;

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char letter : path) {
    if (letter == '.') {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

bool is_index(const std::string& text) {
  return !text.empty() && text.size() < 9 && text.find_first_not_of("0123456789") == std::string::npos;
}

// The value that the text gives: TOML, or a string that needs no quotes.
toml::table parsed_value(const std::string& text) {
  if (text.find_first_of("\r\n") == std::string::npos) {
    try {
      toml::table parsed = toml::parse("value = " + text);
      if (parsed.size() == 1) return parsed;
    } catch (const toml::parse_error&) {
    }
  }
  return toml::table{{"value", text}};
}

// Elements of an array of tables can be changed, not made one by one.
void require_no_index(const std::vector<std::string>& path, std::size_t from) {
  std::string section;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    section += (section.empty() ? "" : ".") + path[i];
    const Section* known = find_section(section);
    if (i >= from && known != nullptr && known->repeated && is_index(path[i + 1])) {
      throw InputError(fmt::format("there is no {} {}: the scene has 0", section, path[i + 1]));
    }
  }
}

// Puts overrides of one origin into the tables.
class Override {
 public:
  Override(SceneTables& tables, const std::string& key, std::string_view origin)
      : tables_(tables), path_(split(key)), origin_(origin) {}

  // Errors: InputError where the key leads nowhere.
  void put(const toml::node& value) {
    toml::node* into = &tables_.root;
    std::string section;
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const std::string& name = path_[i];
      const bool last = i + 1 == path_.size();
      const bool repeated = find_section(section) != nullptr && find_section(section)->repeated;
      if (auto* array = into->as_array()) {
        const std::size_t index = element_of(*array, section, name);
        if (last) return replace(*array, index, value);
        into = array->get(index);
      } else if (auto* table = into->as_table()) {
        toml::node* next = table->get(name);
        if (repeated && name == "0" && next == nullptr) {
          // One table that could be several: it is number 0 itself.
        } else if (repeated && is_index(name)) {
          throw InputError(fmt::format("there is no {} {}: the scene has 1", section, name));
        } else if (next == nullptr || last) {
          if (next == nullptr) require_no_index(path_, i);
          return put_from(*table, i, value);
        } else {
          into = next;
        }
      } else {
        throw InputError(fmt::format("{} is one value and has no \"{}\"", section, name));
      }
      if (last) throw InputError("a whole table cannot be replaced; name one of its keys");
      section += (section.empty() ? "" : ".") + name;
      if (repeated && is_index(name)) section.erase(section.rfind('.'));
    }
  }

 private:
  static std::size_t element_of(const toml::array& array, const std::string& section,
                                const std::string& name) {
    if (!is_index(name))
      throw InputError(fmt::format("{0} is an array: name an element, for example {0}.0", section));
    const std::size_t index = std::stoul(name);
    if (index >= array.size())
      throw InputError(fmt::format("there is no {} {}: the scene has {}", section, name, array.size()));
    return index;
  }

  void replace(toml::array& array, std::size_t index, const toml::node& value) {
    const auto at = array.cbegin() + static_cast<std::ptrdiff_t>(index);
    value.visit([&](const auto& one) { array.replace(at, one); });
    tables_.origins.mark(*array.get(index), origin_);
  }

  // The names of the path from `i` on, each in a table of the one before.
  void put_from(toml::table& into, std::size_t i, const toml::node& value) {
    toml::table* table = &into;
    for (; i + 1 < path_.size(); ++i) table = insert(*table, path_[i], toml::table{}).as_table();
    insert(*table, path_[i], value);
  }

  toml::node& insert(toml::table& table, const std::string& name, const toml::node& value) {
    const auto path = std::make_shared<const std::string>(fmt::format("{}{}", override_mark, origin_));
    const toml::key key(name, toml::source_region{{}, {}, path});
    value.visit([&](const auto& one) { table.insert_or_assign(key, one); });
    toml::node& inserted = *table.get(name);
    tables_.origins.mark(inserted, origin_);
    return inserted;
  }

  SceneTables& tables_;
  std::vector<std::string> path_;
  std::string_view origin_;
};

// What the chosen preset gives on this scene; a preset of an override goes before the file's values.
struct ChosenPreset {
  std::vector<PresetValue> values;
  bool over_the_file = false;

  explicit ChosenPreset(const SceneTables& tables) {
    const toml::table& root = tables.root;
    const toml::node* const chosen = root.at_path(preset_key).node();
    const Preset* const preset =
        chosen == nullptr ? nullptr : find_preset(chosen->value_or(std::string_view()));
    if (preset == nullptr) return;
    over_the_file = tables.origins.is_override(*chosen);
    const bool elastic = root.contains("mechanics") && root.at_path("mechanics.on").value_or(true);
    for (const PresetValue& one : preset->values) {
      // A section that is no table is reported when it is read.
      const toml::node* const section = root.get(one.key.substr(0, one.key.find('.')));
      if (one.holds(elastic) && (section == nullptr || section->is_table())) values.push_back(one);
    }
  }
};

}  // namespace

void Origins::mark(const toml::node& node, std::string_view origin) {
  mark_all(node, std::make_shared<const std::string>(fmt::format("{}{}", override_mark, origin)));
}

void Origins::mark_all(const toml::node& node, const std::shared_ptr<const std::string>& path) {
  paths_[&node] = path;
  if (const auto* table = node.as_table())
    for (const auto& [name, value] : *table) mark_all(value, path);
  if (const auto* array = node.as_array())
    for (const toml::node& value : *array) mark_all(value, path);
}

toml::source_region Origins::place(const toml::node& node) const {
  const auto found = paths_.find(&node);
  return found == paths_.end() ? node.source() : toml::source_region{{}, {}, found->second};
}

toml::source_region Origins::place(const toml::key& name, const toml::table& table) const {
  return apps::is_override(name.source()) || !is_override(table) ? name.source() : place(table);
}

bool Origins::is_override(const toml::node& node) const { return paths_.contains(&node); }

bool Origins::is_from_preset(const toml::node& node) const {
  const auto found = paths_.find(&node);
  return found != paths_.end() && std::string_view(*found->second).substr(override_mark.size()) == preset_key;
}

void apply_override(SceneTables& tables, const std::string& key, const toml::node& value,
                    Problems& problems) {
  try {
    Override(tables, key, key).put(value);
  } catch (const InputError& error) {
    problems.add_override(key, error.what());
  }
}

void apply_override(SceneTables& tables, const std::string& text, Problems& problems) {
  const auto trimmed = [](std::string part) {
    part.erase(0, part.find_first_not_of(" \t"));
    part.erase(part.find_last_not_of(" \t") + 1);
    return part;
  };
  const std::size_t equals = text.find('=');
  const std::string key = trimmed(text.substr(0, equals));
  const auto is_key_letter = [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '-' || letter == '.';
  };
  if (equals == std::string::npos || key.empty() || !std::ranges::all_of(key, is_key_letter) ||
      key.front() == '.' || key.back() == '.' || key.find("..") != std::string::npos) {
    problems.add_override(printable(text), "must be section.key=value");
    return;
  }
  apply_override(tables, key, *parsed_value(trimmed(text.substr(equals + 1))).get("value"), problems);
}

void apply_preset(SceneTables& tables) {
  const ChosenPreset preset(tables);
  for (const PresetValue& one : preset.values) {
    const toml::node* const named = tables.root.at_path(one.key).node();
    if (named != nullptr && (!preset.over_the_file || tables.origins.is_override(*named))) continue;
    Override(tables, std::string(one.key), preset_key)
        .put(*parsed_value(std::string(one.value)).get("value"));
  }
}

void leave_to_preset(SceneTables& tables) {
  const ChosenPreset preset(tables);
  for (const PresetValue& one : preset.values) {
    const toml::node* const named = tables.root.at_path(one.key).node();
    if (named == nullptr || !preset.over_the_file || tables.origins.is_override(*named)) continue;
    const auto path = split(std::string(one.key));
    tables.root.get_as<toml::table>(path.front())->erase(path.back());
  }
}

}  // namespace myowave::apps
