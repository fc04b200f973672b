// `myowave run`: a scene from its file, or a stopped run from its checkpoint, into a result folder.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/base/device.hpp"
#include "apps/base/memory.hpp"
#include "apps/base/progress_line.hpp"
#include "apps/base/signals.hpp"
#include "apps/cli/commands.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/input/initial_state.hpp"
#include "apps/input/scene_source.hpp"
#include "apps/input/schema.hpp"
#include "apps/results/run_folder.hpp"
#include "solver/base/error.hpp"
#include "solver/run/device_memory.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/run/memory_watch.hpp"
#include "solver/run/run.hpp"

namespace myowave::apps {
namespace {

struct RunRequest {
  std::string scene;
  std::optional<std::string> out;  // absent: out/<scene name> in the working directory
  std::optional<double> until;     // t.u., in place of time.t_end
  std::vector<std::string> overrides;
  std::optional<std::string> resume;  // result folder of a stopped run; excludes all of the above
  bool force = false;
  bool quiet = false;
};

std::vector<std::string> with_end(std::vector<std::string> overrides, const std::optional<double>& until) {
  if (until && !(std::isfinite(*until) && *until >= 0)) {
    throw solver::InputError(fmt::format("--until must be a time >= 0 (t.u.), not {}", *until));
  }
  if (until) overrides.push_back(fmt::format("time.t_end={}", *until));
  return overrides;
}

// Shows the progress of an initial state, which is computed before the result folder exists.
class SettlingProgress final : public solver::OutputSink {
 public:
  SettlingProgress(const solver::Scene& scene, bool quiet) : line_(scene.time.ms_per_tu, quiet) {}
  void progress(const solver::Progress& progress) override { line_.show(progress); }

 private:
  ProgressLine line_;
};

std::string mean_text(const solver::MeanSd& value, std::string_view unit) {
  return fmt::format("{:.2f} +- {:.2f}{} (n = {})", value.mean, value.sd, unit, value.n);
}

// The peak memory of the run in each memory space of Kokkos: "1.5 MiB in Host (1.6 MiB estimated)".
std::string memory_text(const solver::RunSummary& summary) {
  std::string text;
  const auto estimated = solver::views_of(summary.plan);
  for (const auto& [space, bytes] : summary.memory) {
    text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", bytes_text(bytes), space);
    const auto planned = std::ranges::find(estimated, space, &solver::SpaceBytes::space);
    if (planned != estimated.end()) text += fmt::format(" ({} estimated)", bytes_text(planned->bytes));
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

// Runs from the initial state, or resumes from a checkpoint, and writes the results into the folder.
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
      // A full disk may refuse the summary too. The user needs the error that ended the run.
    }
    if (dynamic_cast<const solver::Interrupted*>(&failure) == nullptr) throw;
    throw solver::Interrupted(
        fmt::format("{}; resume with: myowave run --resume {}", failure.what(), out.string()));
  }
  summary.memory = memory.most();
  folder.write_summary(summary, std::nullopt);
  keeper.remove_all();
  return summary;
}

// A finished run has no checkpoints, and a summary without a failure.
bool is_finished(const std::filesystem::path& out) {
  std::ifstream file(out / "summary.json");
  const auto summary = nlohmann::json::parse(file, nullptr, false);
  return summary.is_object() && summary.contains("failure") && summary["failure"].is_null();
}

void resume(const std::filesystem::path& out, bool quiet) {
  std::vector<std::string> refused;
  const auto found = solver::find_checkpoint(out / checkpoints_name, refused);
  for (const auto& line : refused) fmt::print(stderr, "myowave: not used: {}\n", line);
  if (!found && is_finished(out)) {
    if (!quiet) fmt::print("{}: the run is finished, there is nothing to resume\n", out.string());
    return;
  }
  if (!found)
    throw solver::InputError(
        fmt::format("{}: there is no {}checkpoint to resume from; start the run again, with --force",
                    out.string(), refused.empty() ? "" : "valid "));
  const solver::Scene scene = load_scene(source_from(found->identity));
  const Device device;
  solver::require_device_memory(scene);
  RunFolder folder(out, scene, found->mark, quiet);
  solver::CheckpointKeeper keeper(out / checkpoints_name, found->identity, &*found);
  if (!quiet) fmt::print(stderr, "myowave: resumes from {}, t = {:g} t.u.\n", found->file.string(), found->t);
  try {
    const auto summary = run_into(folder, out, scene, {}, keeper, &*found);
    if (!quiet) print_result(scene, summary, out);
  } catch (const solver::StateMismatch& error) {
    throw solver::InputError(fmt::format(
        "{}: {}; resume with the program that has the git hash in {}, or start the run again, with --force",
        found->file.string(), error.what(), (out / "manifest.json").string()));
  }
}

// Errors: InputError; NumericalFailure and Interrupted, after the results so far are on disk.
void run(const RunRequest& request) {
  watch_signals();
  if (request.resume) return resume(*request.resume, request.quiet);
  if (request.scene.empty())
    throw solver::InputError("SCENE is required, or --resume with the folder of a stopped run");
  const SceneSource source = read_source(request.scene, with_end(request.overrides, request.until));
  const solver::Scene scene = load_scene(source);
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

}  // namespace

void add_run(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("run", "Run a scene and write its results into a folder");
  const auto request = std::make_shared<RunRequest>();
  const auto [scene, set] = add_scene_options(*command, request->scene, request->overrides);
  scene->required(false);
  CLI::Option* const out =
      command
          ->add_option("--out", request->out, "Result folder; default: out/<scene> in the working directory")
          ->type_name("DIR");
  CLI::Option* const until =
      command->add_option("--until", request->until, "End at this time (t.u.) instead of time.t_end")
          ->type_name("T");
  CLI::Option* const force =
      command->add_flag("--force", request->force, "Write into a folder that already holds results");
  CLI::Option* const resume =
      command
          ->add_option("--resume", request->resume, "Resume the run that was stopped in this result folder")
          ->type_name("DIR");
  for (CLI::Option* own : {scene, set, out, until, force}) resume->excludes(own);
  command->add_flag("--quiet", request->quiet, "No progress and no result on the terminal");
  command->callback([request] { run(*request); });
}

}  // namespace myowave::apps
