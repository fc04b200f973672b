#include "apps/sweep/sweep_slurm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using solver::InputError;

// sbatch replaces %A and the like by numbers.
std::string without_patterns(const std::string& path) {
  std::string result;
  for (const char letter : path) result += letter == '%' ? "%%" : std::string(1, letter);
  return result;
}

std::string sweep_command(const fs::path& program, const fs::path& file, const fs::path& folder,
                          std::string_view shard, const SlurmOptions& options) {
  return fmt::format("{} sweep {} --out {} --shard {}/{} --jobs {}", shell_quoted(program.string()),
                     shell_quoted(file.string()), shell_quoted(folder.string()), shard, options.tasks,
                     options.cpus);
}

}  // namespace

std::string shell_quoted(std::string_view text) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("/._-+=:,@").find(char(c)) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, plain)) return std::string(text);
  std::string quoted = "'";
  for (const char letter : text) quoted += letter == '\'' ? R"('\'')" : std::string(1, letter);
  return quoted + "'";
}

std::string slurm_script(const fs::path& program, const fs::path& file, const fs::path& folder,
                         const SlurmOptions& options) {
  const std::string gpus = options.gpus > 0 ? fmt::format("#SBATCH --gpus-per-task={}\n", options.gpus) : "";
  return fmt::format(
      R"(#!/bin/bash
# Each task runs one shard of a sweep. Submit it again if runs are missing: finished runs are not repeated.
#SBATCH --job-name=myowave_sweep
#SBATCH --array=1-{tasks}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={cpus}
{gpus}#SBATCH --time={time}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR1@120
#SBATCH --output="{log}/slurm_%A_%a.log"

export OMP_NUM_THREADS={cpus} OMP_PROC_BIND=false
{command} &
child=$!

# Slurm signals this shell only: USR1 two minutes before the time limit, TERM if the job is cancelled or
# preempted. The unfinished runs then save checkpoints.
cancelled=no
trap 'kill -USR1 "$child"' USR1
trap 'cancelled=yes; kill -TERM "$child"' TERM

# A signal ends wait, not the child.
status=0
while wait "$child"; status=$?; kill -0 "$child" 2>/dev/null; do :; done

# 75: stopped on request, to be resumed.
if [ "$status" -eq 75 ] && [ "$cancelled" = no ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit "$status"
)",
      fmt::arg("tasks", options.tasks), fmt::arg("cpus", options.cpus), fmt::arg("gpus", gpus),
      fmt::arg("time", options.time), fmt::arg("log", without_patterns(folder.string())),
      fmt::arg("command", sweep_command(program, file, folder, "\"$SLURM_ARRAY_TASK_ID\"", options)));
}

std::string parallel_line(const fs::path& program, const fs::path& file, const fs::path& folder,
                          const SlurmOptions& options) {
  // --resume-failed: repeating the line runs the unfinished shards.
  return fmt::format(
      "seq {0} | OMP_NUM_THREADS={1} OMP_PROC_BIND=false parallel --joblog {2} --resume-failed --jobs $(( "
      "($(nproc) + {3}) / {1} )) {4}",
      options.tasks, options.cpus, shell_quoted((folder / "parallel.log").string()), options.cpus - 1,
      sweep_command(program, file, folder, "{}", options));
}

void require_valid(const SlurmOptions& options) {
  constexpr int most_tasks = 10000;
  if (options.tasks < 1 || options.tasks > most_tasks)
    throw InputError(fmt::format("--tasks must be 1 to {}, not {}", most_tasks, options.tasks));
  if (options.cpus < 1) throw InputError(fmt::format("--cpus must be at least 1, not {}", options.cpus));
  if (options.gpus < 0) throw InputError(fmt::format("--gpus must be at least 0, not {}", options.gpus));
  if (options.time.empty() || options.time.find_first_not_of("0123456789:-") != std::string::npos)
    throw InputError(
        fmt::format("--time must be as sbatch takes it, for example 24:00:00 or 2-00:00:00, not "
                    "\"{}\"",
                    options.time));
}

}  // namespace myowave::apps
