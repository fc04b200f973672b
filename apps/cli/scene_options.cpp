#include "apps/cli/scene_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/base/memory.hpp"
#include "solver/run/stages.hpp"

namespace myowave::apps {

SceneOptions add_scene_options(CLI::App& command, std::string& scene, std::vector<std::string>& overrides) {
  CLI::Option* const file =
      command.add_option("SCENE", scene, "Scene file (TOML); `myowave describe` lists its keys")->required();
  CLI::Option* const set =
      command
          .add_option(
              "--set", overrides,
              "Replace a value of the file: section.key=value. Strings need no quotes. Repeat for more")
          ->type_name("KEY=VALUE")
          ->take_all()
          ->expected(1)
          ->allow_extra_args(false);
  return {file, set};
}

solver::Scene load_scene(const SceneSource& source) {
  solver::Scene scene = source.scene();
  solver::require_stable_step(scene);
  require_memory(scene);
  return scene;
}

std::string time_text(double t, const solver::Scene& scene) {
  return fmt::format("{:g} t.u. ({:g} ms)", t, t * scene.time.ms_per_tu);
}

}  // namespace myowave::apps
