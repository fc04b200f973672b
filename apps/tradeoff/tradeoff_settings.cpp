#include "apps/tradeoff/tradeoff_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "apps/input/did_you_mean.hpp"
#include "apps/input/presets.hpp"
#include "apps/input/toml_input.hpp"
#include "apps/tradeoff/tradeoff_errors.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

using solver::InputError;

constexpr std::array all{
    Dial{"accuracy.precision", "float64,float32", false, "of V, r and Ta"},
    Dial{"time.dt", "0.005,0.01,0.02,0.04,0.05,0.1", false, "step of the excitation, t.u."},
    Dial{"accuracy.dx", "0.5,0.66666666666666667,0.83333333333333333,1,1.25,1.6666666666666667,2", false,
         "largest node spacing; without other values, these times grid.dx"},
    Dial{"accuracy.scheme", "euler,split", false,
         "step and stencil: five-point with `euler`, nine-point with `split`"},
    Dial{"feedback.metric", "none,conservative,expanded", true, "how the deformation acts on conduction"},
    Dial{"feedback.time", "held,linear,quadratic", true, "extrapolation of the deformation"},
    Dial{"mechanics.interval", "10,20,40,80,160,320", true, "steps from one solve to the next"},
    Dial{"mechanics.cells_per_element", "2,5,10,25", true, "size of an element, in grid.dx"},
    Dial{"mechanics.tolerance", "1e-2,1e-4,1e-6,1e-8,1e-10", true, "where Newton stops"},
    Dial{"output.watch_every", "0.2,0.5,1", false, "t.u. between samples of the tips"},
};

std::string_view last_part(std::string_view key) { return key.substr(key.rfind('.') + 1); }

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.emplace_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

template <class Value>
std::optional<Value> number(std::string_view text) {
  Value value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

const Dial& find_dial(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Dial& dial : all) {
    if (name == dial.key || name == last_part(dial.key)) return dial;
    names.insert(names.end(), {dial.key, last_part(dial.key)});
  }
  std::vector<std::string_view> keys;
  for (const Dial& dial : all) keys.push_back(dial.key);
  throw InputError(fmt::format("--axes: there is no dial \"{}\"{}; dials: {}", printable(name),
                               hint(did_you_mean(name, names)), fmt::join(keys, ", ")));
}

std::vector<std::string> usual_values(const Dial& dial, const solver::Scene& scene) {
  std::vector<std::string> values = split(dial.values, ',');
  if (dial.key == "accuracy.dx")
    for (auto& value : values) value = fmt::format("{:.15g}", *number<double>(value) * scene.grid.dx);
  return values;
}

void require_effect(const Dial& dial, const solver::Scene& scene) {
  if (dial.elastic && !scene.mechanics)
    throw InputError(fmt::format("--axes: {} has no effect: the sheet of this scene is rigid", dial.key));
}

// All combinations of one value of each.
std::vector<std::vector<std::string>> combinations(std::span<const DialValues> axes) {
  constexpr std::size_t most = 1000;
  std::vector<std::vector<std::string>> result{{}};
  for (const auto& axis : axes) {
    if (result.size() * axis.values.size() > most)
      throw InputError(
          fmt::format("--product: these dials have more than {} combinations; name fewer of them, or fewer "
                      "values, by --axes",
                      most));
    std::vector<std::vector<std::string>> longer;
    for (const auto& one : result)
      for (const auto& value : axis.values) {
        longer.push_back(one);
        longer.back().push_back(axis.key + '=' + value);
      }
    result = std::move(longer);
  }
  return result;
}

}  // namespace

std::span<const Dial> dials() { return all; }

std::vector<DialValues> parse_axes(std::string_view text, const solver::Scene& scene) {
  std::vector<DialValues> axes;
  if (trimmed(text) == "none") return axes;
  if (trimmed(text).empty()) {
    for (const Dial& dial : all)
      if (!dial.elastic || scene.mechanics)
        axes.push_back({std::string(dial.key), usual_values(dial, scene)});
    return axes;
  }
  const auto add = [&](const Dial& dial, std::vector<std::string> values) {
    require_effect(dial, scene);
    if (std::ranges::find(axes, dial.key, &DialValues::key) != axes.end())
      throw InputError(fmt::format("--axes: {} is named twice", dial.key));
    axes.push_back({std::string(dial.key), std::move(values)});
  };
  for (const std::string& part : split(text, ';')) {
    const auto equals = part.find('=');
    if (equals == part.npos) {
      for (const std::string& name : split(part, ',')) {
        const Dial& dial = find_dial(name);
        add(dial, usual_values(dial, scene));
      }
      continue;
    }
    const Dial& dial = find_dial(trimmed(std::string_view(part).substr(0, equals)));
    std::vector<std::string> values = split(std::string_view(part).substr(equals + 1), ',');
    const auto wrong = std::ranges::find_if(
        values, [](const auto& value) { return value.empty() || value.find('=') != value.npos; });
    if (wrong != values.end())
      throw InputError(fmt::format("--axes: \"{}\" must be {}=VALUE,VALUE,...; a semicolon ends it",
                                   printable(part), dial.key));
    add(dial, std::move(values));
  }
  return axes;
}

std::vector<Setting> make_settings(std::span<const DialValues> axes, bool product) {
  std::vector<Setting> settings;
  const auto choose = [](const Preset& preset) { return fmt::format("accuracy.preset={}", preset.name); };
  for (const Preset& preset : presets())
    if (!preset.values.empty()) settings.push_back({std::string(preset.name), {choose(preset)}});
  std::vector<std::vector<std::string>> changes;
  if (product) {
    changes = combinations(axes);
  } else {
    for (const auto& axis : axes)
      for (const auto& value : axis.values) changes.push_back({axis.key + '=' + value});
  }
  for (const Preset& preset : presets()) {
    if (!preset.varied) continue;
    for (const auto& change : changes) {
      Setting setting{fmt::format("{}, {}", preset.name, fmt::join(change, ", ")), {choose(preset)}};
      setting.overrides.insert(setting.overrides.end(), change.begin(), change.end());
      settings.push_back(std::move(setting));
    }
  }
  return settings;
}

std::vector<std::string> reference_overrides(const solver::Scene& own, int k) {
  constexpr double coupling = 0.4;  // t.u. from one solve to the next on the coarsest grid
  constexpr double slowest = 0.05;  // dt of the coarsest, where D asks for none
  constexpr double sampling = 0.2;  // t.u.
  const auto& cell = own.excitation;
  const double dx = own.grid.dx, parts = solver::contracts(own) ? 12 : 6;
  const double stable = cell.D > 0 ? dx * dx * cell.C_m / (parts * cell.D) : slowest;
  // Steps of the coarsest grid between samples.
  const int steps = static_cast<int>(std::ceil(sampling / std::min(stable, slowest) - 1e-9));
  std::vector<std::string> overrides{"accuracy.preset=reference"};
  const auto set = [&](std::string_view key, const auto& value) {
    std::erase_if(overrides, [&](const auto& one) { return one.starts_with(fmt::format("{}=", key)); });
    overrides.push_back(fmt::format("{}={}", key, value));
  };
  // By name, because what --set gives goes before a preset.
  for (const PresetValue& one : find_preset("reference")->values)
    if (one.holds(own.mechanics.has_value())) set(one.key, one.value);
  set("accuracy.dx", fmt::format("{:.15g}", dx / k));
  set("time.dt", sampling / (steps * k * k));
  for (const char* key : {"output.every", "output.tips_every", "output.probes_every"}) set(key, sampling);
  if (!own.mechanics) return overrides;
  // coupling / k
  set("mechanics.interval", static_cast<int>(std::lround(coupling / sampling)) * steps * k);
  if (own.metric == solver::MetricForm::expanded) set("accuracy.scheme", "euler");
  if (solver::contracts(own)) set("accuracy.on_unstable", "substep");
  return overrides;
}

std::vector<ErrorTarget> parse_targets(const std::vector<std::string>& texts) {
  std::vector<ErrorTarget> targets;
  std::vector<std::string_view> names;
  for (const Observable& one : observables()) names.push_back(one.name);
  for (const auto& text : texts) {
    for (const std::string& part : split(text, ',')) {
      const auto equals = std::min(part.find('='), part.size());
      const std::string name(trimmed(std::string_view(part).substr(0, equals)));
      const Observable* observable = find_observable(name);
      if (observable == nullptr)
        throw InputError(fmt::format("--target: there is no error \"{}\"{}; errors: {}", printable(name),
                                     hint(did_you_mean(name, names)), fmt::join(names, ", ")));
      std::string_view value = equals < part.size() ? trimmed(std::string_view(part).substr(equals + 1)) : "";
      if (observable->unit == "%" && value.ends_with('%')) value.remove_suffix(1);
      const auto largest = number<double>(trimmed(value));
      if (!largest || !(*largest > 0) || !std::isfinite(*largest))
        throw InputError(fmt::format("--target: \"{}\" must be {}=E with a number E > 0 ({})",
                                     printable(part), name, observable->unit));
      targets.push_back({name, *largest});
    }
  }
  return targets;
}

std::vector<int> parse_levels(std::string_view text) {
  std::vector<int> levels;
  for (const std::string& part : split(text, ',')) levels.push_back(number<int>(part).value_or(0));
  constexpr int finest = 64;
  const bool fine = levels.size() == 3 && levels[0] >= 1 && levels[0] < levels[1] && levels[1] < levels[2] &&
                    levels[2] <= finest;
  if (!fine)
    throw InputError(
        fmt::format("--levels must be three integers from 1 to {}, each larger than the one before "
                    "it, not \"{}\"",
                    finest, printable(text)));
  return levels;
}

}  // namespace myowave::apps
