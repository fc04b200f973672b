// `myowave stability`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "apps/base/device.hpp"
#include "apps/cli/commands.hpp"
#include "apps/results/run_folder.hpp"
#include "apps/stability/stability.hpp"

namespace myowave::apps {
namespace {

struct StabilityRequest {
  std::string map;                    // empty: all
  std::string out = "out/stability";  // relative to the working directory
  bool force = false;
};

// Errors: InputError; NumericalFailure, after all files are written, where a wrong result passed silently.
void run(const StabilityRequest& request) {
  const auto maps = choose_maps(request.map);
  RunFolder::require_free(request.out, request.force);
  const Device device;
  write_maps(maps, request.out);
}

// The names of all maps, a line each with what it shows.
std::string map_names() {
  std::string text = "Maps:\n";
  for (const auto& map : solver::stability_maps()) text += fmt::format("  {:<20}{}\n", map.name, map.doc);
  return text;
}

}  // namespace

void add_stability(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "stability", "Map where a step is right, wrong or blows up; write tables and pictures into a folder");
  const auto request = std::make_shared<StabilityRequest>();
  command->add_option("--map", request->map, "Only this map")->type_name("NAME");
  command->add_option("--out", request->out, "Result folder; default: out/stability in the working directory")
      ->type_name("DIR");
  command->add_flag("--force", request->force, "Write into a folder that already holds results");
  command->footer(map_names());
  command->callback([request] { run(*request); });
}

}  // namespace myowave::apps
