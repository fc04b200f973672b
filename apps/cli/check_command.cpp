// `myowave check`: what a scene models, its memory and its time. Leaves no file behind.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Kokkos_Core.hpp>
#include <cmath>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/base/device.hpp"
#include "apps/base/memory.hpp"
#include "apps/cli/commands.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/input/initial_state.hpp"
#include "apps/results/estimate.hpp"
#include "solver/excitation/stability.hpp"
#include "solver/run/device_memory.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/scene/grid_spacing.hpp"

namespace myowave::apps {
namespace {

std::string seconds_text(double seconds) {
  if (seconds < 10) return fmt::format("about {:.1f} s", seconds);
  if (seconds < 120) return fmt::format("about {:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("about {:.0f} min", seconds / 60);
  return fmt::format("about {:.1f} h", seconds / 3600);
}

void print_plan(const solver::Plan& plan, double nodes) {
  fmt::print("{:<18}{:>12}  {}\n", "part", "bytes/node", "what it is, or why it is not modelled");
  for (const auto& part : plan.parts) {
    const std::string bytes = part.bytes() > 0 ? fmt::format("{:.1f}", part.bytes() / nodes) : "";
    fmt::print("{:<18}{:>12}  {}\n", part.part, bytes,
               part.active ? fmt::format("{} ({})", part.what, part.why)
                           : fmt::format("not modelled: {}", part.why));
  }
}

void print_memory(const solver::Plan& plan, double nodes) {
  fmt::print("memory   {}; bytes a node: {:.0f} of state, {:.0f} of coefficients, {:.0f} in all\n",
             bytes_text(plan.bytes()), plan.state_bytes_per_node, plan.coefficient_bytes_per_node,
             plan.bytes() / nodes);
  for (const auto& [space, bytes] : solver::views_of(plan)) {
    const bool on_host = space == Kokkos::HostSpace::name() || !solver::has_device_memory();
    const auto free = on_host ? free_memory() : solver::free_device_memory();
    fmt::print("         {} in the Views of Kokkos' memory space {}{}\n", bytes_text(bytes), space,
               free ? fmt::format(", {} are free there", bytes_text(*free)) : "");
  }
}

void print_time(const solver::Scene& scene) {
  try {
    const Estimate time = estimate(scene);
    fmt::print("time     {}", seconds_text(time.total_s()));
    if (time.settling_s > 0)
      fmt::print(", {} of it to settle the spiral (not in the cache)", seconds_text(time.settling_s));
    if (time.preconditions_s > 0) fmt::print(", {} of it preconditions", seconds_text(time.preconditions_s));
    fmt::print("\n");
  } catch (const std::exception& failure) {  // in the first steps, or in the temporary folder
    fmt::print("time     unknown: {}\n", failure.what());
  }
}

// Errors: InputError.
void check(const std::string& file, const std::vector<std::string>& overrides) {
  const solver::Scene scene = load_scene(read_source(file, overrides));
  const solver::InitialSettings& initial = scene.initial;
  if (initial.type == solver::InitialSettings::Type::file) {
    const solver::GridSettings sheet = grid_of_start(scene);
    read_state(initial.file, sheet.rows, sheet.columns, initial.window);
  }
  fmt::print("{}: valid\n", file);
  const solver::Plan plan = solver::make_plan(scene);
  const auto nodes = static_cast<double>(scene.grid.rows) * scene.grid.columns;
  print_plan(plan, nodes);
  for (const std::string& warning : solver::warnings_of(scene)) fmt::print("warning  {}\n", warning);
  fmt::print("length   {}, {} steps\n", time_text(scene.time.t_end, scene),
             std::llround(scene.time.t_end / scene.time.dt));
  const Device device;
  print_memory(plan, nodes);
  std::cout << std::flush;
  solver::require_device_memory(scene);
  print_time(scene);
}

}  // namespace

void add_check(CLI::App& app) {
  struct Options {
    std::string scene;
    std::vector<std::string> overrides;
  };
  CLI::App* const command =
      app.add_subcommand("check", "Print what a scene models, its memory and its time; write nothing");
  const auto options = std::make_shared<Options>();
  add_scene_options(*command, options->scene, options->overrides);
  command->callback([options] { check(options->scene, options->overrides); });
}

}  // namespace myowave::apps
