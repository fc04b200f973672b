#include "apps/input/presets.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace myowave::apps {
namespace {

constexpr auto rigid = PresetValue::Sheet::rigid, elastic = PresetValue::Sheet::elastic;

// dt near dx^2 / (6 D), where the errors of the split scheme cancel. On a contracting sheet dx is that of the
// front, which runs into what is stretched; elements of 6 length units have seven cells a side, or eight.
std::vector<PresetValue> large_steps(const std::vector<PresetValue>& steps) {
  std::vector<PresetValue> values{{"accuracy.precision", "\"float32\""},
                                  {"accuracy.scheme", "\"split\""},
                                  {"accuracy.on_unstable", "\"substep\"", elastic},
                                  {"output.watch_every", "1.0"},
                                  {"feedback.time", "\"quadratic\"", elastic}};
  values.insert(values.end(), steps.begin(), steps.end());
  return values;
}

// Measured errors and costs: `myowave help accuracy`.
std::vector<Preset> make_presets() {
  return {
      {.name = "none", .doc = "the scene's own values"},
      {.name = "paper",
       .doc = "the paper's scheme and steps",
       .values = {{"accuracy.dx", "0.6"},
                  {"time.dt", "0.02"},
                  {"accuracy.precision", "\"float64\""},
                  {"accuracy.scheme", "\"euler\""},
                  {"output.watch_every", "0.2"},
                  {"feedback.time", "\"held\"", elastic},
                  {"mechanics.interval", "80", elastic},
                  {"mechanics.tolerance", "1e-8", elastic}},
       .varied = true},
      {.name = "fast",
       .doc = "large steps for waves and their periods, not for break-up times",
       .values = large_steps({{"accuracy.dx", "1.15", rigid},
                              {"time.dt", "0.2", rigid},
                              {"accuracy.dx", "0.86", elastic},
                              {"time.dt", "0.125", elastic},
                              {"mechanics.interval", "16", elastic},
                              {"mechanics.tolerance", "1e-3", elastic}})},
      {.name = "balanced",
       .doc = "more accurate than `paper` at less cost",
       .values = large_steps({{"accuracy.dx", "0.75"},
                              {"time.dt", "0.08333333333333333"},
                              {"mechanics.interval", "20", elastic},
                              {"mechanics.tolerance", "1e-4", elastic}}),
       .varied = true},
      {.name = "reference",
       .doc = "a fine grid and small steps, to compare the others with",
       .values = {{"accuracy.dx", "0.3"},
                  {"time.dt", "0.014285714285714285", rigid},
                  {"time.dt", "0.0125", elastic},  // most contracted sheets bear it undivided
                  {"accuracy.precision", "\"float64\""},
                  {"accuracy.scheme", "\"split\""},
                  {"accuracy.on_unstable", "\"substep\"", elastic},
                  {"output.watch_every", "0.2"},
                  {"feedback.time", "\"quadratic\"", elastic},
                  {"mechanics.interval", "16", elastic},
                  {"mechanics.tolerance", "1e-10", elastic}}},
  };
}

}  // namespace

std::span<const Preset> presets() {
  static const std::vector<Preset> table = make_presets();
  return table;
}

const Preset* find_preset(std::string_view name) {
  const auto found = std::ranges::find(presets(), name, &Preset::name);
  return found == presets().end() ? nullptr : &*found;
}

const PresetValue* find_value(const Preset& preset, std::string_view key, bool on_elastic_sheet) {
  const auto found = std::ranges::find_if(preset.values, [&](const PresetValue& value) {
    return value.key == key && value.holds(on_elastic_sheet);
  });
  return found == preset.values.end() ? nullptr : &*found;
}

std::string presets_text() {
  std::string text;
  for (const Preset& one : presets())
    text += fmt::format("{}`{}`: {}", text.empty() ? "" : "; ", one.name, one.doc);
  return text;
}

std::string values_text(const Preset& preset) {
  std::string text;
  for (const auto& [key, value, sheet] : preset.values)
    text += fmt::format("{}{}={}{}", text.empty() ? "" : ", ", key, value,
                        sheet == rigid     ? " (rigid)"
                        : sheet == elastic ? " (elastic)"
                                           : "");
  return text;
}

}  // namespace myowave::apps
