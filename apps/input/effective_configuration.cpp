// The values of a scene in the shape of a scene file.
#include <nlohmann/json.hpp>

#include "apps/input/schema.hpp"

namespace myowave::apps {
namespace {

nlohmann::json region_json(const solver::Stimulus& stimulus) {
  switch (stimulus.shape) {
    case solver::Stimulus::Shape::disc:
      return {{"center", stimulus.center}, {"radius", stimulus.radius}};
    case solver::Stimulus::Shape::block:
      return {{"columns", stimulus.columns}, {"rows", stimulus.rows}};
    case solver::Stimulus::Shape::all:
      break;
  }
  return "all";
}

nlohmann::json values_of(const Section& section, const Target& target) {
  nlohmann::json values = nlohmann::json::object();
  const auto type = value_of(*find_key(*find_section("initial"), "type"), target).get<std::string>();
  for (std::string_view other : section.inherits) values.update(values_of(*find_section(other), target));
  for (const Key& key : section.keys) {
    if (!key.only_type.empty() && key.only_type != type) continue;
    if (key.name == "window" && !target.scene.initial.window) continue;
    nlohmann::json value = value_of(key, target);
    if (!value.is_null()) values[std::string(key.name)] = std::move(value);
  }
  return values;
}

}  // namespace

nlohmann::json value_of(const Key& key, const Target& target) {
  return std::visit(Overloaded{
                        [&](const Choice& kind) -> nlohmann::json { return kind.names[kind.get(target)]; },
                        [&](const Choices& kind) -> nlohmann::json {
                          nlohmann::json chosen = nlohmann::json::array();
                          const auto flags = kind.get(target);
                          for (std::size_t n = 0; n < flags.size(); ++n)
                            if (flags[n]) chosen.push_back(kind.names[n]);
                          return chosen;
                        },
                        [&](const Size&) -> nlohmann::json {
                          return {target.scene.grid.rows, target.scene.grid.columns};
                        },
                        [&](const Probes&) -> nlohmann::json { return target.scene.output.probes; },
                        [&](const Region&) -> nlohmann::json { return region_json(*target.stimulus); },
                        [&](const auto& kind) -> nlohmann::json {
                          return kind.get ? nlohmann::json(kind.get(target)) : nlohmann::json();
                        },
                    },
                    key.kind);
}

nlohmann::json effective_configuration(const solver::Scene& given) {
  solver::Scene scene = given;  // a Target may change what it refers to
  Target whole(scene);
  nlohmann::json configuration = nlohmann::json::object();
  for (const Section& section : schema()) {
    if (section.repeated) continue;
    const std::string name(section.name);
    if (name == "mechanics" && !scene.mechanics) {
      configuration[name] = {{"on", false}};
    } else {
      configuration[name] = values_of(section, whole);
    }
  }
  for (solver::Precondition& one : scene.initial.preconditions) {
    configuration["initial"]["precondition"].push_back(
        values_of(*find_section("initial.precondition"), Target(scene, one)));
  }
  for (solver::Stimulus& one : scene.stimuli) {
    configuration["stimulus"].push_back(values_of(*find_section("stimulus"), Target(scene, one)));
  }
  return configuration;
}

}  // namespace myowave::apps
