// What the commands share that take a scene.
#pragma once

#include <string>
#include <vector>

#include "apps/input/scene_source.hpp"
#include "solver/scene/scene.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace myowave::apps {

struct SceneOptions {
  CLI::Option *scene, *set;
};

// Adds SCENE, which is required, and --set.
SceneOptions add_scene_options(CLI::App& command, std::string& scene, std::vector<std::string>& overrides);

// The scene, checked: its step is stable and the host's memory holds it.
// Errors: InputError.
solver::Scene load_scene(const SceneSource&);

// "12 t.u. (57.6 ms)"
std::string time_text(double t, const solver::Scene&);

}  // namespace myowave::apps
