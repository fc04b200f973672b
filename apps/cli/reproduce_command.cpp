// `myowave reproduce`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "apps/cli/commands.hpp"
#include "apps/paper/reproduce.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

struct ReproduceRequest {
  std::vector<std::string> figures;  // numbers, or "all"
  bool quick = false;
  std::string out = "out/reproduce";  // relative to the working directory
  int jobs = 0;                       // runs at once; 0: one a core, or one where a device computes
};

int default_jobs() {
  constexpr bool on_host = std::is_same_v<Kokkos::DefaultExecutionSpace, Kokkos::DefaultHostExecutionSpace>;
  return on_host ? static_cast<int>(std::max(1u, std::thread::hardware_concurrency())) : 1;
}

// Errors: InputError; NumericalFailure, after all that could be made is on disk, where a run failed.
void run(const ReproduceRequest& request) {
  const auto figures = choose_figures(request.figures);
  if (request.jobs < 0)
    throw solver::InputError(fmt::format("--jobs must be at least 1, not {}", request.jobs));
  std::string command = "myowave reproduce";
  for (const auto& number : request.figures) command += ' ' + number;
  if (request.figures.empty()) command += " all";
  if (request.quick) command += " --quick";
  reproduce(figures, request.quick ? Extent::quick : Extent::full, request.out,
            request.jobs > 0 ? request.jobs : default_jobs(), command);
}

// The numbers of all figures, a line each with what it shows.
std::string figure_names() {
  std::string text = "Figures:\n";
  for (const auto& recipe : figure_recipes())
    text += fmt::format("  {:<10}{}\n", recipe.number, recipe.title);
  return text;
}

}  // namespace

void add_reproduce(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "reproduce", "Make the figures of the paper: runs, data, pictures, our numbers beside the paper's");
  const auto request = std::make_shared<ReproduceRequest>();
  command->add_option("FIGURE", request->figures, "Numbers of figures; default, or `all`: all of them");
  command->add_flag("--quick", request->quick, "The same from shorter and fewer runs");
  command->add_option("--out", request->out, "Result folder; default: out/reproduce in the working directory")
      ->type_name("DIR");
  command->add_option("--jobs", request->jobs, "Parallel runs; default: one per core")->type_name("J");
  command->footer(figure_names());
  command->callback([request] { run(*request); });
}

}  // namespace myowave::apps
