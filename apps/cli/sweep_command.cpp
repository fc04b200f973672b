// `myowave sweep` with its own subcommands `status` and `table`.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "apps/cli/commands.hpp"
#include "apps/sweep/sweep.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

struct SweepOptions {
  SweepRequest request;
  SlurmOptions slurm;
  std::string folder;
  bool csv = false, json = false, wants_slurm = false;
};

void add_slurm(CLI::App& command, SweepOptions& options) {
  CLI::Option* const with_slurm = command.add_flag(
      "--slurm", options.wants_slurm, "Write the script of a Slurm job array into the folder; run nothing");
  const auto for_slurm = [&](const char* name, auto& value, const char* words) {
    command.add_option(name, value, words)->needs(with_slurm)->capture_default_str();
  };
  for_slurm("--tasks", options.slurm.tasks, "Tasks of the array, one shard each");
  for_slurm("--time", options.slurm.time, "Time limit of a task");
  for_slurm("--cpus", options.slurm.cpus, "Cores of a task");
  for_slurm("--gpus", options.slurm.gpus, "GPUs of a task");
}

void run(const SweepOptions& options) {
  if (options.request.file.empty())
    throw solver::InputError(
        "myowave: SWEEP is required: a sweep file, or status or table with a sweep's folder\nRun `myowave "
        "sweep --help` for its options.");
  SweepRequest request = options.request;
  if (options.wants_slurm) request.slurm = options.slurm;
  sweep(request);
}

}  // namespace

void add_sweep(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("sweep", "Run a scene for many parameter values; resume where it stopped");
  const auto options = std::make_shared<SweepOptions>();
  SweepRequest& request = options->request;
  command->add_option("SWEEP", request.file, "Sweep file (TOML), see apps/sweep/README.md");
  command
      ->add_option("--out", request.out, "Folder of the sweep; default: out/<sweep> in the working directory")
      ->type_name("DIR");
  command->add_option("--shard", request.shard, "Only part I of N, from 1")->type_name("I/N");
  command->add_option("--jobs", request.jobs, "Parallel runs; default: one per core")->type_name("J");
  command->add_flag("--dry-run", request.dry_run,
                    "Print what would be done and how long it takes; write nothing");
  command->add_flag("--retry-failed", request.retry_failed, "Repeat failed runs");
  command->add_flag("--redo-other-revisions", request.redo_other_revisions,
                    "Repeat runs of another revision of myowave");
  command->add_flag("--quiet", request.quiet, "No progress on the terminal");
  add_slurm(*command, *options);

  CLI::App* const status = command->add_subcommand("status", "Print the progress of a sweep");
  status->add_option("DIR", options->folder, "Folder of a sweep")->required();
  CLI::App* const table =
      command->add_subcommand("table", "Print one row per run, from the records of all shards");
  table->add_option("DIR", options->folder, "Folder of a sweep")->required();
  auto* const as_csv = table->add_flag("--csv", options->csv, "As CSV");
  table->add_flag("--json", options->json, "As JSON")->excludes(as_csv);
  command->require_subcommand(0, 1);

  command->callback([options, status, table] {
    if (status->parsed()) return sweep_status(options->folder);
    if (table->parsed())
      return sweep_table(options->folder, options->csv    ? TableFormat::csv
                                          : options->json ? TableFormat::json
                                                          : TableFormat::text);
    run(*options);
  });
}

}  // namespace myowave::apps
