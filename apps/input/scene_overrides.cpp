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

// The table that holds nothing but this value, its nodes marked as from the override of `origin`.
toml::table override_table(const std::string& key, const std::string& value, const std::string& origin) {
  const std::string source = std::string(override_mark) + origin;
  if (value.find_first_of("\r\n") == std::string::npos) {
    try {
      return toml::parse(fmt::format("{} = {}", key, value), source);
    } catch (const toml::parse_error&) {
      // No TOML value: a string that needs no quotes.
    }
  }
  return toml::parse(fmt::format("{} = {}", key, toml_string(value)), source);
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

// Puts the override's value where the path leads. Errors: InputError where it leads nowhere.
void merge(toml::table& root, toml::table&& given, const std::vector<std::string>& path) {
  toml::node* into = &root;
  toml::table* from = &given;
  std::string section;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string& name = path[i];
    toml::node& value = *from->get(name);
    const bool last = i + 1 == path.size();
    const bool repeated = find_section(section) != nullptr && find_section(section)->repeated;
    if (auto* array = into->as_array()) {
      if (!is_index(name))
        throw InputError(fmt::format("{0} is an array: name an element, for example {0}.0", section));
      const std::size_t index = std::stoul(name);
      if (index >= array->size()) {
        throw InputError(fmt::format("there is no {} {}: the scene has {}", section, name, array->size()));
      }
      if (last) {
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(index), std::move(value));
        return;
      }
      into = array->get(index);
    } else if (auto* table = into->as_table()) {
      toml::node* next = table->get(name);
      if (repeated && name == "0" && next == nullptr) {
        // One table that could be several: it is number 0 itself.
      } else if (repeated && is_index(name)) {
        throw InputError(fmt::format("there is no {} {}: the scene has 1", section, name));
      } else if (next == nullptr || last) {
        if (next == nullptr) require_no_index(path, i);
        // The parsed key, not its text: it knows where it comes from.
        table->insert_or_assign(from->find(name)->first, std::move(value));
        return;
      } else {
        into = next;
      }
    } else {
      throw InputError(fmt::format("{} is one value and has no \"{}\"", section, name));
    }
    if (last) throw InputError("a whole table cannot be replaced; name one of its keys");
    section += (section.empty() ? "" : ".") + name;
    if (repeated && is_index(name)) section.erase(section.rfind('.'));
    from = value.as_table();
  }
}

// What the chosen preset gives on this scene; a preset of an override goes before the file's values.
struct ChosenPreset {
  std::vector<PresetValue> values;
  bool over_the_file = false;

  explicit ChosenPreset(const toml::table& root) {
    const toml::node* const chosen = root.at_path(preset_key).node();
    const Preset* const preset =
        chosen == nullptr ? nullptr : find_preset(chosen->value_or(std::string_view()));
    if (preset == nullptr) return;
    over_the_file = is_override(chosen->source());
    const bool elastic = root.contains("mechanics") && root.at_path("mechanics.on").value_or(true);
    for (const PresetValue& one : preset->values) {
      // A section that is no table is told of when it is read.
      const toml::node* const section = root.get(one.key.substr(0, one.key.find('.')));
      if (one.holds(elastic) && (section == nullptr || section->is_table())) values.push_back(one);
    }
  }
};

}  // namespace

bool is_from_preset(const toml::node& node) {
  const auto& origin = node.source().path;
  return origin && *origin == std::string(override_mark) + std::string(preset_key);
}

void apply_override(toml::table& root, const std::string& text, Problems& problems) {
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
  try {
    merge(root, override_table(key, trimmed(text.substr(equals + 1)), key), split(key));
  } catch (const toml::parse_error& error) {
    problems.add_override(key, std::string(error.description()));
  } catch (const InputError& error) {
    problems.add_override(key, error.what());
  }
}

void apply_preset(toml::table& root) {
  const ChosenPreset preset(root);
  for (const PresetValue& one : preset.values) {
    const std::string key(one.key);
    const toml::node* const named = root.at_path(key).node();
    if (named != nullptr && (!preset.over_the_file || is_override(named->source()))) continue;
    merge(root, override_table(key, std::string(one.value), std::string(preset_key)), split(key));
  }
}

void leave_to_preset(toml::table& root) {
  const ChosenPreset preset(root);
  for (const PresetValue& one : preset.values) {
    const toml::node* const named = root.at_path(one.key).node();
    if (named == nullptr || !preset.over_the_file || is_override(named->source())) continue;
    const auto path = split(std::string(one.key));
    root.get_as<toml::table>(path.front())->erase(path.back());
  }
}

}  // namespace myowave::apps
