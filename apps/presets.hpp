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
};

struct Preset {
  std::string_view name;
  double dx;  // accuracy.dx, which its time.dt is for; 0: any
  std::span<const PresetValue> values;
};

// In the order of solver::Preset, the first of which is none.
std::span<const Preset> presets();

// Null where there is none of this name.
const Preset* find_preset(std::string_view name);

}  // namespace myowave::apps
