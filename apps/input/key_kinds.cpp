#include "apps/input/key_kinds.hpp"

#include "apps/input/presets.hpp"

namespace myowave::apps::kinds {

Choice tension_law() {
  Choice law;
  for (const solver::NamedTensionLaw& one : solver::tension_laws) law.names.push_back(one.name);
  law.get = [](const Target& target) { return static_cast<std::size_t>(target.tension.law); };
  law.set = [](Target& target, std::size_t index) {
    target.tension.law = static_cast<solver::TensionLaw>(index);
    target.tension.eps_below.reset();
    target.tension.eps_above.reset();
  };
  return law;
}

Choice preset() {
  Choice choice{{},
                [](const Target& target) -> std::size_t {
                  const Preset* one = find_preset(target.scene.preset);
                  return one == nullptr ? 0 : one - presets().data();
                },
                [](Target& target, std::size_t index) { target.scene.preset = presets()[index].name; }};
  for (const Preset& one : presets()) choice.names.push_back(one.name);
  return choice;
}

std::vector<Note> preset_notes() {
  std::vector<Note> notes;
  for (const Preset& one : presets())
    if (!one.values.empty()) notes.push_back({std::string(one.name), values_text(one)});
  return notes;
}

Choices stop_on() {
  return {{"breakup", "death"},
          [](const Target& target) {
            const solver::StopOn& on = target.scene.time.stop_on;
            return std::vector<bool>{on.breakup, on.death};
          },
          [](Target& target, const std::vector<bool>& on) {
            target.scene.time.stop_on = {on[0], on[1]};
          }};
}

Number tension_eps0() {
  const auto multiply_both = [](Target& target, double eps0) {
    const auto rates = solver::tension_parameters(target.tension);
    target.tension.eps_below = rates.eps_below * eps0;
    target.tension.eps_above = rates.eps_above * eps0;
  };
  return {nullptr, multiply_both, positive};
}

Number tension_rate(double cell::ActiveTensionParameters<double>::*rate,
                    std::optional<double> solver::TensionSettings::*own) {
  return {[rate](const Target& target) { return solver::tension_parameters(target.tension).*rate; },
          [own](Target& target, double value) { target.tension.*own = value; }, not_negative};
}

Number output_every() {
  const auto set_all = [](Target& target, double every) {
    target.scene.output.every = target.scene.output.tips_every = target.scene.output.probes_every = every;
  };
  return {[](const Target& target) { return target.scene.output.every; }, set_all, positive};
}

Pair window() {
  return {"[row0, column0]",
          [](const Target& target) {
            return target.scene.initial.window.value_or(std::array{0, 0});
          },
          [](Target& target, std::array<int, 2> value) { target.scene.initial.window = value; },
          {.low = 0, .high = largest_int}};
}

}  // namespace myowave::apps::kinds
