// Accuracy by one word: what `accuracy.preset` stands for.
#pragma once

#include <span>
#include <string_view>

namespace myowave::apps {

struct PresetValue {
  enum class Sheet { any, rigid, elastic };
  std::string_view key;    // "time.dt"
  std::string_view value;  // as TOML
  Sheet sheet = Sheet::any;

  constexpr bool holds(bool elastic) const {
    return sheet == Sheet::any || (sheet == Sheet::elastic) == elastic;
  }
};

struct Preset {
  std::string_view name;
  std::span<const PresetValue> values;
};

// In the order of solver::Preset, the first of which is none.
std::span<const Preset> presets();

// Null where there is none of this name.
const Preset* find_preset(std::string_view name);

// What it gives the key on an elastic or a rigid sheet; null for nothing.
const PresetValue* find_value(const Preset&, std::string_view key, bool elastic);

}  // namespace myowave::apps
