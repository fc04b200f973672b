// A sweep on several machines: the script of a Slurm job array, and the line for GNU parallel.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace myowave::apps {

struct SlurmOptions {
  int tasks = 8;                  // shards
  std::string time = "24:00:00";  // limit of a task, as sbatch takes it
  int cpus = 2;                   // cores a task
  int gpus = 0;                   // GPUs a task
};

// Runs shard $SLURM_ARRAY_TASK_ID of the sweep with `program`. At the time limit or another signal the runs
// save checkpoints, and the task is queued again.
std::string slurm_script(const std::filesystem::path& program, const std::filesystem::path& sweep_file,
                         const std::filesystem::path& sweep_folder, const SlurmOptions&);

// The same shards on one machine, in parallel as far as it has cores.
std::string parallel_line(const std::filesystem::path& program, const std::filesystem::path& sweep_file,
                          const std::filesystem::path& sweep_folder, const SlurmOptions&);

// One word of a shell's line.
std::string shell_quoted(std::string_view);

// Errors: InputError for what sbatch would refuse.
void require_valid(const SlurmOptions&);

}  // namespace myowave::apps
