// Accuracy by one word: what each `accuracy.preset` stands for. A row of the table in presets.cpp is all that
// a preset is: the schema, the documentation and the settings of `myowave tradeoff` follow from it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace myowave::apps {

struct PresetValue {
  enum class Sheet { any, rigid, elastic };
  std::string_view key;    // "time.dt"
  std::string_view value;  // as TOML
  Sheet sheet = Sheet::any;

  bool holds(bool elastic) const { return sheet == Sheet::any || (sheet == Sheet::elastic) == elastic; }
};

struct Preset {
  std::string_view name;
  std::string_view doc;  // what it is for
  std::vector<PresetValue> values{};
  bool varied = false;  // `myowave tradeoff` also changes its dials one at a time
};

// The first is `none`, the default, without values.
std::span<const Preset> presets();

// Null where there is none of this name.
const Preset* find_preset(std::string_view name);

// What it gives the key on an elastic or a rigid sheet; null for nothing.
const PresetValue* find_value(const Preset&, std::string_view key, bool elastic);

// "`paper`: ...; `fast`: ...", every preset with its `doc`.
std::string presets_text();
// "time.dt=0.2 (rigid), ...", every value of one.
std::string values_text(const Preset&);

}  // namespace myowave::apps
