#include "apps/presets.hpp"

#include <algorithm>
#include <array>

namespace myowave::apps {
namespace {

using Sheet = PresetValue::Sheet;

constexpr std::array paper{
    PresetValue{"time.dt", "0.02"},
    PresetValue{"accuracy.precision", "\"float64\""},
    PresetValue{"accuracy.scheme", "\"euler\""},
    PresetValue{"output.watch_every", "0.2"},
    PresetValue{"feedback.time", "\"held\"", Sheet::elastic},
    PresetValue{"mechanics.interval", "80", Sheet::elastic},
    PresetValue{"mechanics.tolerance", "1e-8", Sheet::elastic},
};

// dt near dx^2 / (6 D), where the split scheme's errors go; on a contracting sheet, whose nodes come closer,
// what is stable there.
constexpr std::array fast{
    PresetValue{"time.dt", "0.1", Sheet::rigid},
    PresetValue{"time.dt", "0.05", Sheet::elastic},
    PresetValue{"accuracy.precision", "\"float32\""},
    PresetValue{"accuracy.scheme", "\"split\""},
    PresetValue{"accuracy.on_unstable", "\"substep\"", Sheet::elastic},
    PresetValue{"output.watch_every", "1.0"},
    PresetValue{"feedback.time", "\"quadratic\"", Sheet::elastic},
    PresetValue{"mechanics.interval", "60", Sheet::elastic},
    PresetValue{"mechanics.tolerance", "1e-4", Sheet::elastic},
};

constexpr std::array balanced{
    PresetValue{"time.dt", "0.1", Sheet::rigid},
    PresetValue{"time.dt", "0.05", Sheet::elastic},
    PresetValue{"accuracy.precision", "\"float32\""},
    PresetValue{"accuracy.scheme", "\"split\""},
    PresetValue{"accuracy.on_unstable", "\"substep\"", Sheet::elastic},
    PresetValue{"output.watch_every", "1.0"},
    PresetValue{"feedback.time", "\"quadratic\"", Sheet::elastic},
    PresetValue{"mechanics.interval", "32", Sheet::elastic},
    PresetValue{"mechanics.tolerance", "1e-5", Sheet::elastic},
};

constexpr std::array reference{
    PresetValue{"time.dt", "0.0125"},
    PresetValue{"accuracy.precision", "\"float64\""},
    PresetValue{"accuracy.scheme", "\"split\""},
    PresetValue{"output.watch_every", "0.2"},
    PresetValue{"feedback.time", "\"quadratic\"", Sheet::elastic},
    PresetValue{"mechanics.interval", "16", Sheet::elastic},
    PresetValue{"mechanics.tolerance", "1e-10", Sheet::elastic},
};

constexpr std::array<Preset, 5> all{{{"none", 0, {}},
                                     {"paper", 0.6, paper},
                                     {"fast", 1, fast},
                                     {"balanced", 0.75, balanced},
                                     {"reference", 0.3, reference}}};

}  // namespace

std::span<const Preset> presets() { return all; }

const Preset* find_preset(std::string_view name) {
  const auto found = std::ranges::find(all, name, &Preset::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace myowave::apps
