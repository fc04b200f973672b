#include "apps/cli/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <type_traits>

#include "apps/base/device.hpp"
#include "apps/base/memory.hpp"
#include "apps/base/progress_line.hpp"
#include "apps/base/revision.hpp"
#include "apps/base/signals.hpp"
#include "apps/input/initial_state.hpp"
#include "apps/input/resample.hpp"
#include "apps/input/scene_file.hpp"
#include "apps/input/scene_source.hpp"
#include "apps/input/schema.hpp"
#include "apps/paper/reproduce.hpp"
#include "apps/results/estimate.hpp"
#include "apps/results/run_folder.hpp"
#include "apps/stability/stability.hpp"
#include "solver/base/error.hpp"
#include "solver/excitation/stability.hpp"
#include "solver/run/device_memory.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/run/memory_watch.hpp"
#include "solver/run/run.hpp"
#include "solver/run/stages.hpp"

namespace myowave::apps {
namespace {

std::vector<std::string> with_end(std::vector<std::string> overrides, const std::optional<double>& until) {
  if (until && !(std::isfinite(*until) && *until >= 0)) {
    throw solver::InputError(fmt::format("--until must be a time >= 0 (t.u.), not {}", *until));
  }
  if (until) overrides.push_back(fmt::format("time.t_end={}", *until));
  return overrides;
}

solver::Scene load(const SceneSource& source) {
  solver::Scene scene = source.scene();
  solver::require_stable_step(scene);
  require_memory(scene);
  return scene;
}

// Tells how far a state has come that is computed before there is a result folder.
class SettlingProgress final : public solver::OutputSink {
 public:
  SettlingProgress(const solver::Scene& scene, bool quiet) : line_(scene.time.ms_per_tu, quiet) {}
  void progress(const solver::Progress& progress) override { line_.show(progress); }

 private:
  ProgressLine line_;
};

std::string time_text(double t, const solver::Scene& scene) {
  return fmt::format("{:g} t.u. ({:g} ms)", t, t * scene.time.ms_per_tu);
}

std::string mean_text(const solver::MeanSd& value, std::string_view unit) {
  return fmt::format("{:.2f} +- {:.2f}{} (n = {})", value.mean, value.sd, unit, value.n);
}

// Of each of Kokkos' memory spaces what the run took at most: "1.5 MiB in Host (1.6 MiB foretold)".
std::string memory_text(const solver::RunSummary& summary) {
  std::string text;
  const auto foretold = solver::views_of(summary.plan);
  for (const auto& [space, bytes] : summary.memory) {
    text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", bytes_text(bytes), space);
    const auto planned = std::ranges::find(foretold, space, &solver::SpaceBytes::space);
    if (planned != foretold.end()) text += fmt::format(" ({} foretold)", bytes_text(planned->bytes));
  }
  return text;
}

void print_result(const solver::Scene& scene, const solver::RunSummary& summary,
                  const std::filesystem::path& folder) {
  const solver::Observables& seen = summary.observables;
  fmt::print("{}: t = {} in {:.1f} s, {:.0f} Mcell-steps/s\n", scene.name, time_text(summary.t, scene),
             summary.wall_s, summary.cell_steps_per_s / 1e6);
  if (seen.period.n > 0) fmt::print("  period      {}\n", mean_text(seen.period, " t.u."));
  if (seen.tips.n > 0) fmt::print("  tips        {}\n", mean_text(seen.tips, ""));
  if (seen.breakup_tu) fmt::print("  break-up    at {}\n", time_text(*seen.breakup_tu, scene));
  if (seen.death_tu) fmt::print("  died        at {}\n", time_text(*seen.death_tu, scene));
  if (seen.area)
    fmt::print("  area        {:.3f} to {:.3f} of the loaded rest state\n", seen.area->first,
               seen.area->second);
  if (seen.shortening) {
    fmt::print("  shortening  {:.1f} % at t = {}\n", 100 * seen.shortening->first,
               time_text(seen.shortening->second, scene));
  }
  if (!summary.memory.empty()) fmt::print("  memory      {}\n", memory_text(summary));
  fmt::print("  results     {}\n", folder.string());
}

std::string seconds_text(double seconds) {
  if (seconds < 10) return fmt::format("about {:.1f} s", seconds);
  if (seconds < 120) return fmt::format("about {:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("about {:.0f} min", seconds / 60);
  return fmt::format("about {:.1f} h", seconds / 3600);
}

void print_plan(const solver::Plan& plan, double nodes) {
  fmt::print("{:<18}{:>12}  {}\n", "part", "bytes/node", "what it is, or why it is not there");
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
      fmt::print(", {} of it to settle the spiral, which the cache lacks", seconds_text(time.settling_s));
    if (time.preconditions_s > 0) fmt::print(", {} of it preconditions", seconds_text(time.preconditions_s));
    fmt::print("\n");
  } catch (const std::exception& failure) {  // of the first steps, or of the temporary folder
    fmt::print("time     unknown: {}\n", failure.what());
  }
}

// Runs, or goes on from a checkpoint, and leaves what came of it in the folder.
solver::RunSummary run_into(RunFolder& folder, const std::filesystem::path& out, const solver::Scene& scene,
                            solver::InitialState initial, solver::CheckpointKeeper& keeper,
                            const solver::FoundCheckpoint* from) {
  solver::RunSummary summary;
  const solver::MemoryWatch memory;
  try {
    solver::run(scene, std::move(initial), folder, summary,
                {.stop = &stop_requested(), .checkpoints = &keeper, .resume = from});
  } catch (const std::exception& failure) {
    summary.memory = memory.most();
    try {
      folder.write_summary(summary, failure.what());
    } catch (const std::exception&) {
      // A full disk may refuse the summary too; what ended the run is what the user needs to know.
    }
    if (dynamic_cast<const solver::Interrupted*>(&failure) == nullptr) throw;
    throw solver::Interrupted(
        fmt::format("{}; go on with: myowave run --resume {}", failure.what(), out.string()));
  }
  summary.memory = memory.most();
  folder.write_summary(summary, std::nullopt);
  keeper.remove_all();
  return summary;
}

// A run that has ended has no checkpoints, and a summary without a failure.
bool has_ended(const std::filesystem::path& out) {
  std::ifstream file(out / "summary.json");
  const auto summary = nlohmann::json::parse(file, nullptr, false);
  return summary.is_object() && summary.contains("failure") && summary["failure"].is_null();
}

void resume(const std::filesystem::path& out, bool quiet) {
  std::vector<std::string> refused;
  const auto found = solver::find_checkpoint(out / checkpoints_name, refused);
  for (const auto& line : refused) fmt::print(stderr, "myowave: not used: {}\n", line);
  if (!found && has_ended(out)) {
    if (!quiet) fmt::print("{}: the run has ended, there is nothing to go on with\n", out.string());
    return;
  }
  if (!found)
    throw solver::InputError(
        fmt::format("{}: there is no checkpoint to go on from{}; begin the run again, with --force",
                    out.string(), refused.empty() ? "" : " that is sound"));
  const solver::Scene scene = load(source_from(found->identity));
  const Device device;
  solver::require_device_memory(scene);
  RunFolder folder(out, scene, found->mark, quiet);
  solver::CheckpointKeeper keeper(out / checkpoints_name, found->identity, &*found);
  if (!quiet) fmt::print(stderr, "myowave: goes on from {}, t = {:g} t.u.\n", found->file.string(), found->t);
  try {
    const auto summary = run_into(folder, out, scene, {}, keeper, &*found);
    if (!quiet) print_result(scene, summary, out);
  } catch (const solver::StateMismatch& error) {
    throw solver::InputError(fmt::format(
        "{}: {}; go on with the one whose git hash is in {}, or begin the run again, with --force",
        found->file.string(), error.what(), (out / "manifest.json").string()));
  }
}

}  // namespace

void run(const RunRequest& request) {
  watch_signals();
  if (request.resume) return resume(*request.resume, request.quiet);
  if (request.scene.empty())
    throw solver::InputError("SCENE is required, or --resume with the folder of a stopped run");
  const SceneSource source = read_source(request.scene, with_end(request.overrides, request.until));
  const solver::Scene scene = load(source);
  const std::filesystem::path out =
      request.out ? std::filesystem::path(*request.out) : std::filesystem::path("out") / scene.name;
  // Everything that can refuse the run comes before its folder, where --force replaces old results.
  RunFolder::require_free(out, request.force);
  const Device device;
  solver::require_device_memory(scene);
  solver::InitialState initial = [&] {
    SettlingProgress progress(scene, request.quiet);
    return resolve_initial_state(scene, progress);
  }();

  RunFolder folder(out, scene, request.force, request.quiet);
  folder.write_manifest(effective_configuration(scene));
  solver::CheckpointKeeper keeper(out / checkpoints_name, source.json());
  const auto summary = run_into(folder, out, scene, std::move(initial), keeper, nullptr);
  if (!request.quiet) print_result(scene, summary, out);
}

void check(const std::string& file, const std::vector<std::string>& overrides) {
  const solver::Scene scene = load(read_source(file, overrides));
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

void describe(const std::string& section, bool markdown) {
  std::cout << (markdown ? describe_markdown() : describe(section));
}

void stability(const StabilityRequest& request) {
  const auto maps = choose_maps(request.map);
  RunFolder::require_free(request.out, request.force);
  const Device device;
  write_maps(maps, request.out);
}

std::string map_names() {
  std::string text = "Maps:\n";
  for (const auto& map : solver::stability_maps()) text += fmt::format("  {:<20}{}\n", map.name, map.doc);
  return text;
}

void reproduce(const ReproduceRequest& request) {
  const auto figures = choose_figures(request.figures);
  constexpr bool on_host = std::is_same_v<Kokkos::DefaultExecutionSpace, Kokkos::DefaultHostExecutionSpace>;
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (request.jobs < 0)
    throw solver::InputError(fmt::format("--jobs must be at least 1, not {}", request.jobs));
  std::string command = "myowave reproduce";
  for (const auto& number : request.figures) command += ' ' + number;
  if (request.figures.empty()) command += " all";
  if (request.quick) command += " --quick";
  reproduce(figures, request.quick ? Extent::quick : Extent::full, request.out,
            request.jobs > 0 ? request.jobs
            : on_host        ? cores
                             : 1,
            command);
}

std::string figure_names() {
  std::string text = "Figures:\n";
  for (const auto& recipe : figure_recipes())
    text += fmt::format("  {:<10}{}\n", recipe.number, recipe.title);
  return text;
}

void info() {
  const Device device;
  fmt::print("myowave       {}\n", version());
  fmt::print("git           {}{}\n", git_revision(), has_local_changes() ? " with changes" : "");
  fmt::print("backend       {}, {} threads or streams at once\n", Kokkos::DefaultExecutionSpace::name(),
             Kokkos::DefaultExecutionSpace().concurrency());
  fmt::print("host backend  {}, {} threads\n", Kokkos::DefaultHostExecutionSpace::name(),
             Kokkos::DefaultHostExecutionSpace().concurrency());
  fmt::print("devices       {}\n",
             Kokkos::num_devices() > 0 ? std::to_string(Kokkos::num_devices()) : "none, runs on the host");
  fmt::print("Kokkos        {}.{}.{}\n\n", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100,
             KOKKOS_VERSION % 100);
  std::ostringstream configuration;
  Kokkos::print_configuration(configuration);
  fmt::print("{}", configuration.str());
}

}  // namespace myowave::apps
