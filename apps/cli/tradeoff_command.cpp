// `myowave tradeoff`.
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/cli/commands.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/tradeoff/tradeoff.hpp"

namespace myowave::apps {

void add_tradeoff(CLI::App& app) {
  struct Options {
    TradeoffRequest request;
    bool list = false;
  };
  CLI::App* const command =
      app.add_subcommand("tradeoff", "Measure time and error of a scene's accuracy settings");
  const auto options = std::make_shared<Options>();
  TradeoffRequest& request = options->request;
  add_scene_options(*command, request.scene, request.overrides).scene->required(false);
  command->add_option("--out", request.out, "Result folder")->type_name("DIR");
  command->add_flag("--force", request.force, "Write into a folder that already holds results");
  command
      ->add_option("--axes", request.axes,
                   "Dials, as \"time.dt=0.01,0.02;accuracy.scheme=euler,split\" or by name; default: all")
      ->type_name("LIST");
  command->add_flag("--product", request.product, "All combinations of the dials instead of each alone");
  command
      ->add_option("--target", request.targets,
                   "Largest errors, as period=1%,cv=2%: target.toml is the cheapest setting that meets them")
      ->type_name("ERRORS")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->add_option("--budget", request.budget, "Start no setting after this measured time")
      ->type_name("SECONDS");
  command->add_option("--repetitions", request.repetitions, "Runs of each setting")->capture_default_str();
  command->add_option("--levels", request.levels, "Grids of the reference, nodes a grid.dx")
      ->type_name("A,B,C")
      ->capture_default_str();
  command->add_flag("--refine-elements", request.refine_elements,
                    "Shrink the elements of the reference with its grids; default: those of the scene");
  command->add_option("--starts", request.starts, "Starts per setting of a chaotic scene")
      ->capture_default_str();
  command->add_flag("--list", options->list, "Only print the dials and the presets");
  command->callback([options] { options->list ? list_dials() : tradeoff(options->request); });
}

}  // namespace myowave::apps
