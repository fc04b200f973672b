#include "apps/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "apps/initial_state.hpp"
#include "apps/memory.hpp"
#include "apps/progress_line.hpp"
#include "apps/run_folder.hpp"
#include "apps/scene_file.hpp"
#include "apps/schema.hpp"
#include "apps/stability.hpp"
#include "myowave_version.hpp"
#include "solver/error.hpp"
#include "solver/run.hpp"
#include "solver/stability.hpp"

namespace myowave::apps {
namespace {

// Kokkos for one command. Its advice on thread binding is for those who launch it themselves.
class Device {
 public:
  Device() {
    if (!Kokkos::is_initialized()) {
      Kokkos::initialize(Kokkos::InitializationSettings().set_disable_warnings(true));
      owned_ = true;
    }
  }
  ~Device() {
    if (owned_) Kokkos::finalize();
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

 private:
  bool owned_ = false;
};

solver::Scene load(const std::string& file, std::vector<std::string> overrides,
                   const std::optional<double>& until) {
  if (until && !(std::isfinite(*until) && *until >= 0)) {
    throw solver::InputError(fmt::format("--until must be a time >= 0 (t.u.), not {}", *until));
  }
  if (until) overrides.push_back(fmt::format("time.t_end={}", *until));
  solver::Scene scene = read_scene(file, overrides);
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
  fmt::print("  results     {}\n", folder.string());
}

std::int64_t step_count(double duration, const solver::Scene& scene) {
  return std::llround(duration / scene.time.dt);
}

// Mean Newton iterations of a warm-started solve every 80 steps, measured over 1345 t.u. of spirals
// on 25 x 25 elements.
double iterations_per_solve(const solver::Scene& scene) {
  return scene.tension.law == "printed" ? 10.8 : 6.8;
}

struct Estimate {
  double scene_s = 0;
  double preconditions_s = 0;
};

// Extrapolates the time of the whole scene from a few steps of it. They start from a broken front,
// as work depends on what the sheet does.
Estimate estimate(const solver::Scene& scene) {
  const auto nodes = static_cast<double>(scene.grid.rows) * scene.grid.columns;
  constexpr double trial_node_steps = 1e9;  // about a second
  const auto steps = static_cast<std::int64_t>(std::clamp(trial_node_steps / nodes, 20.0, 400.0));

  solver::Scene trial = scene;
  trial.time.t_end = static_cast<double>(steps) * scene.time.dt;
  trial.initial = {};
  trial.initial.type = solver::InitialSettings::Type::broken_front;
  if (trial.mechanics)
    trial.mechanics->interval =
        static_cast<int>(std::min<std::int64_t>(scene.mechanics->interval, steps / 4));
  solver::OutputSink nowhere;
  solver::RunSummary summary;
  solver::run(trial, solver::make_initial_state(trial), nowhere, summary);

  const solver::PhaseSeconds& phases = summary.phases;
  const double step_s = (phases.excitation + phases.transfer + phases.observe) / static_cast<double>(steps);
  Estimate result;
  result.scene_s = static_cast<double>(step_count(scene.time.t_end, scene)) * step_s;
  for (const auto& one : scene.initial.preconditions) {
    result.preconditions_s += static_cast<double>(step_count(one.duration, scene)) * step_s;
  }
  if (scene.mechanics && summary.mechanics.newton_iterations > 0) {
    const double solve_s = phases.mechanics / static_cast<double>(summary.mechanics.newton_iterations) *
                           iterations_per_solve(scene);
    const auto solves = [&](double duration) {
      return static_cast<double>(step_count(duration, scene) / scene.mechanics->interval + 1);
    };
    result.scene_s += solves(scene.time.t_end) * solve_s;
    for (const auto& one : scene.initial.preconditions) {
      if (one.contraction) result.preconditions_s += solves(one.duration) * solve_s;
    }
  }
  return result;
}

std::string seconds_text(double seconds) {
  if (seconds < 1) return "less than 1 s";
  if (seconds < 120) return fmt::format("about {:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("about {:.0f} min", seconds / 60);
  return fmt::format("about {:.1f} h", seconds / 3600);
}

}  // namespace

void run(const RunRequest& request) {
  const solver::Scene scene = load(request.scene, request.overrides, request.until);
  const std::filesystem::path out =
      request.out ? std::filesystem::path(*request.out) : std::filesystem::path("out") / scene.name;
  // Everything that can refuse the run comes before its folder, where --force replaces old results.
  RunFolder::require_free(out, request.force);
  const Device device;
  solver::InitialState initial = [&] {
    SettlingProgress progress(scene, request.quiet);
    return resolve_initial_state(scene, progress);
  }();

  RunFolder folder(out, scene, request.force, request.quiet);
  folder.write_manifest(effective_configuration(scene));
  solver::RunSummary summary;
  try {
    solver::run(scene, std::move(initial), folder, summary);
  } catch (const std::exception& failure) {
    try {
      folder.write_summary(summary, failure.what());
    } catch (const std::exception&) {
      // A full disk may refuse the summary too; what ended the run is what the user needs to know.
    }
    throw;
  }
  folder.write_summary(summary, std::nullopt);
  if (!request.quiet) print_result(scene, summary, out);
}

void check(const std::string& file, const std::vector<std::string>& overrides) {
  const solver::Scene scene = load(file, overrides, std::nullopt);
  const solver::InitialSettings& initial = scene.initial;
  if (initial.type == solver::InitialSettings::Type::file) {
    read_state(initial.file, scene.grid.rows, scene.grid.columns, initial.window);
  }
  fmt::print("{}: valid\n", file);
  for (const std::string& line : solver::model_in_words(scene)) fmt::print("  {}\n", line);
  for (const std::string& warning : solver::warnings_of(scene)) fmt::print("warning  {}\n", warning);
  const std::int64_t steps = step_count(scene.time.t_end, scene);
  fmt::print("length   {}, {} steps\n", time_text(scene.time.t_end, scene), steps);
  const auto free = free_memory();
  fmt::print("memory   {}{}\n", bytes_text(solver::memory_bytes(scene)),
             free ? fmt::format(", {} are free", bytes_text(*free)) : "");
  std::cout << std::flush;

  const Device device;
  try {
    const Estimate time = estimate(scene);
    fmt::print("time     {}", seconds_text(time.scene_s));
    if (time.preconditions_s > 0)
      fmt::print(", before it {} of preconditions", seconds_text(time.preconditions_s));
    if (initial.type == solver::InitialSettings::Type::settled_spiral) {
      fmt::print("; the settled spiral is computed first where the cache lacks it");
    }
    fmt::print(" (without outputs)\n");
  } catch (const std::runtime_error& failure) {  // a broken front may be no state for these parameters
    fmt::print("time     unknown: a few steps from a broken front failed: {}\n", failure.what());
  }
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
  for (const auto& map : solver::stability_maps()) text += fmt::format("  {:<14}{}\n", map.name, map.doc);
  return text;
}

void info() {
  const Device device;
  fmt::print("myowave       {}\n", version);
  fmt::print("git           {}{}\n", git_hash, git_dirty ? " with changes" : "");
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
