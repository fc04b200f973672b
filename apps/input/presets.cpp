#include "apps/input/presets.hpp"

#include <algorithm>
#include <array>

namespace myowave::apps {
namespace {

using Sheet = PresetValue::Sheet;

constexpr std::array paper{
    PresetValue{"accuracy.dx", "0.6"},
    PresetValue{"time.dt", "0.02"},
    PresetValue{"accuracy.precision", "\"float64\""},
    PresetValue{"accuracy.scheme", "\"euler\""},
    PresetValue{"output.watch_every", "0.2"},
    PresetValue{"feedback.time", "\"held\"", Sheet::elastic},
    PresetValue{"mechanics.interval", "80", Sheet::elastic},
    PresetValue{"mechanics.tolerance", "1e-8", Sheet::elastic},
};

// `first` and then `second`.
template <std::size_t N, std::size_t M>
constexpr std::array<PresetValue, N + M> joined(const std::array<PresetValue, N>& first,
                                                const std::array<PresetValue, M>& second) {
  std::array<PresetValue, N + M> result{};
  std::ranges::copy(first, result.begin());
  std::ranges::copy(second, result.begin() + N);
  return result;
}

constexpr std::array large_steps{
    PresetValue{"accuracy.precision", "\"float32\""},
    PresetValue{"accuracy.scheme", "\"split\""},
    PresetValue{"accuracy.on_unstable", "\"substep\"", Sheet::elastic},
    PresetValue{"output.watch_every", "1.0"},
    PresetValue{"feedback.time", "\"quadratic\"", Sheet::elastic},
};

// dt near dx^2 / (6 D), where the errors of the split scheme go. On a contracting sheet dx is that of the
// front, which runs into what is stretched; elements of 6 length units have seven cells a side, or eight.
// Measured errors and speeds: apps/tradeoff/ACCURACY.md.
constexpr auto fast = joined(large_steps, std::array{
                                              PresetValue{"accuracy.dx", "1.15", Sheet::rigid},
                                              PresetValue{"time.dt", "0.2", Sheet::rigid},
                                              PresetValue{"accuracy.dx", "0.86", Sheet::elastic},
                                              PresetValue{"time.dt", "0.125", Sheet::elastic},
                                              PresetValue{"mechanics.interval", "16", Sheet::elastic},
                                              PresetValue{"mechanics.tolerance", "1e-3", Sheet::elastic},
                                          });

constexpr auto balanced = joined(large_steps, std::array{
                                                  PresetValue{"accuracy.dx", "0.75"},
                                                  PresetValue{"time.dt", "0.08333333333333333"},
                                                  PresetValue{"mechanics.interval", "20", Sheet::elastic},
                                                  PresetValue{"mechanics.tolerance", "1e-4", Sheet::elastic},
                                              });

constexpr std::array reference{
    PresetValue{"accuracy.dx", "0.3"},
    PresetValue{"time.dt", "0.014285714285714285", Sheet::rigid},
    PresetValue{"time.dt", "0.0125", Sheet::elastic},  // most contracted sheets bear it undivided
    PresetValue{"accuracy.precision", "\"float64\""},
    PresetValue{"accuracy.scheme", "\"split\""},
    PresetValue{"accuracy.on_unstable", "\"substep\"", Sheet::elastic},
    PresetValue{"output.watch_every", "0.2"},
    PresetValue{"feedback.time", "\"quadratic\"", Sheet::elastic},
    PresetValue{"mechanics.interval", "16", Sheet::elastic},
    PresetValue{"mechanics.tolerance", "1e-10", Sheet::elastic},
};

constexpr std::array<Preset, 5> all{
    {{"none", {}}, {"paper", paper}, {"fast", fast}, {"balanced", balanced}, {"reference", reference}}};

}  // namespace

std::span<const Preset> presets() { return all; }

const Preset* find_preset(std::string_view name) {
  const auto found = std::ranges::find(all, name, &Preset::name);
  return found == all.end() ? nullptr : &*found;
}

const PresetValue* find_value(const Preset& preset, std::string_view key, bool elastic) {
  const auto found = std::ranges::find_if(
      preset.values, [&](const PresetValue& value) { return value.key == key && value.holds(elastic); });
  return found == preset.values.end() ? nullptr : &*found;
}

}  // namespace myowave::apps
