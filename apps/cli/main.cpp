// The `myowave` command: reads the command line, calls apps/cli/commands.hpp, turns errors into exit
// status: 0 done, 1 the machine failed, 2 the input is wrong, 3 the numerics failed, 75 stopped on request.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "apps/base/revision.hpp"
#include "apps/cli/commands.hpp"
#include "apps/cli/help.hpp"
#include "apps/input/did_you_mean.hpp"
#include "apps/report/report.hpp"
#include "apps/sweep/sweep.hpp"
#include "apps/tradeoff/tradeoff.hpp"
#include "solver/base/error.hpp"

namespace {

using namespace myowave;

struct SceneOptions {
  CLI::Option *scene, *set;
};

SceneOptions add_scene(CLI::App& command, std::string& scene, std::vector<std::string>& overrides) {
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

// `myowave sweep` and its own subcommands.
struct SweepCommand {
  apps::SweepRequest request;
  apps::SlurmOptions slurm;
  std::string folder;
  bool csv = false, json = false, wants_slurm = false;
  CLI::App *command = nullptr, *status = nullptr, *table = nullptr;
  CLI::Option* with_slurm = nullptr;

  explicit SweepCommand(CLI::App& app) {
    command = app.add_subcommand("sweep", "Run a scene for many parameter values; resume where it stopped");
    command->add_option("SWEEP", request.file, "Sweep file (TOML), see apps/sweep/README.md");
    command
        ->add_option("--out", request.out,
                     "Folder of the sweep; default: out/<sweep> in the working directory")
        ->type_name("DIR");
    command->add_option("--shard", request.shard, "Only part I of N, from 1")->type_name("I/N");
    command->add_option("--jobs", request.jobs, "Parallel runs; default: one per core")->type_name("J");
    command->add_flag("--dry-run", request.dry_run,
                      "Print what would be done and how long it takes; write nothing");
    command->add_flag("--retry-failed", request.retry_failed, "Repeat failed runs");
    command->add_flag("--redo-other-revisions", request.redo_other_revisions,
                      "Repeat runs of another revision of myowave");
    command->add_flag("--quiet", request.quiet, "No progress on the terminal");
    with_slurm = command->add_flag("--slurm", wants_slurm,
                                   "Write the script of a Slurm job array into the folder; run nothing");
    const auto for_slurm = [&](const char* name, auto& value, const char* words) {
      command->add_option(name, value, words)->needs(with_slurm)->capture_default_str();
    };
    for_slurm("--tasks", slurm.tasks, "Tasks of the array, one shard each");
    for_slurm("--time", slurm.time, "Time limit of a task");
    for_slurm("--cpus", slurm.cpus, "Cores of a task");
    for_slurm("--gpus", slurm.gpus, "GPUs of a task");
    status = command->add_subcommand("status", "Print the progress of a sweep");
    status->add_option("DIR", folder, "Folder of a sweep")->required();
    table = command->add_subcommand("table", "Print one row per run, from the records of all shards");
    table->add_option("DIR", folder, "Folder of a sweep")->required();
    auto* as_csv = table->add_flag("--csv", csv, "As CSV");
    table->add_flag("--json", json, "As JSON")->excludes(as_csv);
    command->require_subcommand(0, 1);
  }

  void run() {
    if (status->parsed()) return apps::sweep_status(folder);
    if (table->parsed())
      return apps::sweep_table(folder, csv    ? apps::TableFormat::csv
                                       : json ? apps::TableFormat::json
                                              : apps::TableFormat::text);
    if (request.file.empty())
      throw solver::InputError(
          "myowave: SWEEP is required: a sweep file, or status or table with a sweep's folder\nRun `myowave "
          "sweep --help` for its options.");
    if (wants_slurm) request.slurm = slurm;
    apps::sweep(request);
  }
};

struct TradeoffCommand {
  apps::TradeoffRequest request;
  bool list = false;
  CLI::App* command = nullptr;

  explicit TradeoffCommand(CLI::App& app) {
    command = app.add_subcommand("tradeoff", "Measure time and error of a scene's accuracy settings");
    const auto [scene, set] = add_scene(*command, request.scene, request.overrides);
    scene->required(false);
    command->add_option("--out", request.out, "Result folder")->type_name("DIR");
    command->add_flag("--force", request.force, "Write into a folder that already holds results");
    command
        ->add_option("--axes", request.axes,
                     "Dials, as \"time.dt=0.01,0.02;accuracy.scheme=euler,split\" or by name; default: all")
        ->type_name("LIST");
    command->add_flag("--product", request.product, "All combinations of the dials instead of each alone");
    command
        ->add_option(
            "--target", request.targets,
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
    command->add_flag("--list", list, "Only print the dials and the presets");
  }

  void run() { list ? apps::list_dials() : apps::tradeoff(request); }
};

int guarded(const std::function<void()>& command) {
  try {
    command();
    return 0;
  } catch (const solver::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const solver::NumericalFailure& error) {
    fmt::print(stderr, "myowave: the numerics failed: {}\n", error.what());
    return 3;
  } catch (const solver::Interrupted& stopped) {
    fmt::print(stderr, "myowave: {}\n", stopped.what());
    return 75;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "myowave: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "myowave: {}\n", error.what());
  }
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Reaction-diffusion-mechanics of excitable tissue (Nash & Panfilov 2004)", "myowave"};
  app.set_version_flag("--version", fmt::format("myowave {} ({})", apps::version(), apps::git_revision()));
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 1 the machine failed, 2 the input is wrong, 3 the numerics failed,\n"
      "75 stopped on request; resume with `myowave run --resume DIR`.\n"
      "Example: myowave run apps/scenes/quickstart.toml --set excitation.mu1=0.1 --until 50");

  apps::RunRequest request;
  CLI::App* run = app.add_subcommand("run", "Run a scene and write its results into a folder");
  const auto [scene, set] = add_scene(*run, request.scene, request.overrides);
  scene->required(false);
  CLI::Option* const out =
      run->add_option("--out", request.out, "Result folder; default: out/<scene> in the working directory")
          ->type_name("DIR");
  CLI::Option* const until =
      run->add_option("--until", request.until, "End at this time (t.u.) instead of time.t_end")
          ->type_name("T");
  CLI::Option* const force =
      run->add_flag("--force", request.force, "Write into a folder that already holds results");
  CLI::Option* const resume =
      run->add_option("--resume", request.resume, "Resume the run that was stopped in this result folder")
          ->type_name("DIR");
  for (CLI::Option* own : {scene, set, out, until, force}) resume->excludes(own);
  run->add_flag("--quiet", request.quiet, "No progress and no result on the terminal");

  CLI::App* check =
      app.add_subcommand("check", "Print what a scene models, its memory and its time; write nothing");
  add_scene(*check, request.scene, request.overrides);

  std::string section;
  bool markdown = false;
  CLI::App* describe = app.add_subcommand("describe", "Print the reference of scene files");
  describe->add_option("SECTION", section, "Only this section, for example mechanics");
  describe->add_flag("--markdown", markdown,
                     "All sections as the Markdown tables of apps/input/REFERENCE.md");

  apps::StabilityRequest maps;
  CLI::App* stability = app.add_subcommand(
      "stability", "Map where a step is right, wrong or blows up; write tables and pictures into a folder");
  stability->add_option("--map", maps.map, "Only this map")->type_name("NAME");
  stability->add_option("--out", maps.out, "Result folder; default: out/stability in the working directory")
      ->type_name("DIR");
  stability->add_flag("--force", maps.force, "Write into a folder that already holds results");
  stability->footer(apps::map_names());

  apps::ReproduceRequest figures;
  CLI::App* reproduce = app.add_subcommand(
      "reproduce", "Make the figures of the paper: runs, data, pictures, our numbers beside the paper's");
  reproduce->add_option("FIGURE", figures.figures, "Numbers of figures; default, or `all`: all of them");
  reproduce->add_flag("--quick", figures.quick, "The same from shorter and fewer runs");
  reproduce
      ->add_option("--out", figures.out, "Result folder; default: out/reproduce in the working directory")
      ->type_name("DIR");
  reproduce->add_option("--jobs", figures.jobs, "Parallel runs; default: one per core")->type_name("J");
  reproduce->footer(apps::figure_names());

  apps::ReportRequest page;
  CLI::App* report = app.add_subcommand("report", "Make one HTML page about runs");
  report->add_option("DIR", page.folders, "Folders of runs, of sweeps, or of a reproduction")->required();
  report->add_option("--out", page.out, "The page; default: report.html in the first folder")
      ->type_name("FILE");
  report->add_flag("--movie", page.movie, "Also movie.mp4 of each run, by ffmpeg where it is installed");

  SweepCommand sweep(app);
  TradeoffCommand tradeoff(app);

  CLI::App* info =
      app.add_subcommand("info", "Print version, git hash, backends, devices and the Kokkos configuration");

  std::string topic;
  CLI::App* help = app.add_subcommand("help", "Explain a topic, or the options of a subcommand");
  help->add_option("TOPIC", topic, "One of the topics below, or a subcommand");
  help->footer(apps::topic_names());

  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const auto is_command = [&](std::string_view word) {
    return std::ranges::find(names, word) != names.end();
  };
  // CLI11 would only say that a subcommand is missing.
  if (argc > 1 && argv[1][0] != '-' && !is_command(argv[1])) {
    const std::string meant = apps::did_you_mean(argv[1], {names.begin(), names.end()});
    fmt::print(stderr, "myowave: there is no subcommand \"{}\"{}\nRun `myowave --help` for the list.\n",
               argv[1], apps::hint(meant));
    return 2;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);  // --help, --version
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "myowave: {}\n", error.what());
    const CLI::App* near = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
    fmt::print(stderr, "Run `{} --help` for its options.\n",
               near == &app ? "myowave" : "myowave " + near->get_name());
    return 2;
  }

  return guarded([&] {
    if (run->parsed()) apps::run(request);
    if (check->parsed()) apps::check(request.scene, request.overrides);
    if (describe->parsed()) apps::describe(section, markdown);
    if (stability->parsed()) apps::stability(maps);
    if (reproduce->parsed()) apps::reproduce(figures);
    if (report->parsed()) apps::report(page);
    if (sweep.command->parsed()) sweep.run();
    if (tradeoff.command->parsed()) tradeoff.run();
    if (info->parsed()) apps::info();
    // app.help() would print the help of the subcommand `help`.
    if (help->parsed() && topic.empty())
      fmt::print("{}\n{}", app.get_formatter()->make_help(&app, "myowave", CLI::AppFormatMode::Normal),
                 apps::topic_names());
    // Some commands are topics too.
    if (help->parsed() && is_command(topic)) fmt::print("{}", app.get_subcommand(topic)->help("myowave"));
    if (help->parsed() && !topic.empty() && (apps::is_topic(topic) || !is_command(topic)))
      fmt::print("{}", apps::help_text(topic));
  });
}
