#include "apps/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include "apps/base/device.hpp"
#include "apps/base/file_io.hpp"
#include "apps/base/memory.hpp"
#include "apps/base/signals.hpp"
#include "apps/results/estimate.hpp"
#include "apps/sweep/sweep_file.hpp"
#include "apps/sweep/sweep_folder.hpp"
#include "apps/sweep/sweep_members.hpp"
#include "apps/sweep/sweep_progress.hpp"
#include "apps/sweep/sweep_slurm.hpp"
#include "apps/sweep/sweep_table.hpp"
#include "solver/base/error.hpp"
#include "solver/run/device_memory.hpp"
#include "solver/run/ensemble.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using solver::InputError;

// I/N, both from 1.
Shard shard_of(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto count = slash ? std::from_chars(number.ptr + 1, end, shard.count) : number;
  if (!slash || count.ec != std::errc() || count.ptr != end || shard.number < 1 || shard.number > shard.count)
    throw InputError(
        fmt::format("--shard must be I/N with I from 1 to N, for example 1/8, not \"{}\"", text));
  return shard;
}

// Runs of the shard, each id once.
std::vector<const SweepRun*> runs_of(const SweepPlan& plan, const Shard& shard) {
  std::vector<const SweepRun*> runs;
  std::set<std::string> seen;
  std::size_t number = 0;
  for (const SweepRun& run : plan.runs)
    if (seen.insert(run.id).second && shard.has(number++)) runs.push_back(&run);
  return runs;
}

// Runs of a shard that are done, failed and to do.
struct Work {
  std::vector<const SweepRun*> pending;
  std::size_t done = 0, failed = 0, other_revision = 0;
};

Work work_of(const std::vector<const SweepRun*>& runs, const Records& records, const SweepRequest& request) {
  Work work;
  for (const SweepRun* run : runs) {
    const auto record = records.by_id.find(run->id);
    if (record == records.by_id.end()) {
      work.pending.push_back(run);
      continue;
    }
    const bool failure = failed(record->second), other = !of_this_revision(record->second);
    if ((failure && request.retry_failed) || (other && request.redo_other_revisions)) {
      work.pending.push_back(run);
      continue;
    }
    ++work.done;
    work.failed += failure;
    work.other_revision += other;
  }
  return work;
}

void report_records(const Records& records, const Work& work, const SweepRequest& request) {
  for (const auto& line : records.refused) fmt::print(stderr, "myowave: warning: {}\n", line);
  if (work.other_revision > 0)
    fmt::print(stderr,
               "myowave: warning: {} of the finished runs are of another revision of myowave and are not "
               "repeated; --redo-other-revisions repeats them\n",
               work.other_revision);
  if (request.quiet || work.done == 0) return;
  fmt::print(
      stderr, "{} of {} runs are done{}\n", work.done, work.done + work.pending.size(),
      work.failed > 0 ? fmt::format(", {} of them failed (--retry-failed repeats them)", work.failed) : "");
}

int jobs_of(const SweepRequest& request) {
  if (request.jobs < 0) throw InputError(fmt::format("--jobs must be at least 1, not {}", request.jobs));
  return request.jobs > 0 ? request.jobs : solver::most_workers();
}

// Each run fits alone, but the memory may hold fewer parallel runs than there are cores.
int jobs_that_fit(int jobs, const std::vector<const SweepRun*>& runs, bool quiet) {
  MemoryNeed largest;
  for (const SweepRun* run : runs) {
    const MemoryNeed need = memory_need(run->scene);
    largest = {std::max(largest.host, need.host), std::max(largest.device, need.device)};
  }
  const auto free_host = free_memory(), free_device = solver::free_device_memory();
  const int fit = runs_that_fit(jobs, largest, free_host, free_device);
  if (quiet || fit == jobs || std::size_t(fit) >= runs.size()) return fit;
  std::string words;
  const auto add = [&](const char* where, std::uint64_t need, const std::optional<std::uint64_t>& free) {
    if (!free || need == 0) return;
    words += fmt::format("{}{} of the {}'s memory ({} are free)", words.empty() ? "" : ", and ",
                         bytes_text(need), where, bytes_text(*free));
  };
  add("host", largest.host, free_host);
  add("device", largest.device, free_device);
  fmt::print(stderr, "myowave: {} runs in parallel, not {}: a run needs up to {}\n", fit, jobs, words);
  return fit;
}

std::string duration_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

// Scenes of one kind take about the same time per step.
std::string kind_of(const solver::Scene& scene) {
  return fmt::format("{}x{} {} {} {}", scene.grid.rows, scene.grid.columns, scene.mechanics.has_value(),
                     scene.mechanics ? scene.mechanics->cells_per_element : 0, int(scene.precision));
}

// Time of all runs to t_end, sequentially. The number of estimates is bounded, because one takes 2 s.
double estimated_seconds(const std::vector<const SweepRun*>& runs) {
  constexpr std::size_t most_tried = 8;
  std::map<std::string, double> seconds_of_step;
  double total = 0, known = 0;
  std::size_t counted = 0;
  for (const SweepRun* run : runs) {
    const solver::Scene& scene = run->scene;
    const double steps = std::max(1.0, scene.time.t_end / scene.time.dt);
    const std::string kind = kind_of(scene);
    if (!seconds_of_step.contains(kind) && seconds_of_step.size() < most_tried)
      seconds_of_step[kind] = estimate(scene).scene_s / steps;
    if (!seconds_of_step.contains(kind)) continue;
    total += seconds_of_step[kind] * steps;
    known += 1;
    ++counted;
  }
  return counted > 0 ? total * double(runs.size()) / known : 0;
}

void print_dry_run(const SweepPlan& plan, const std::vector<const SweepRun*>& runs, const Work& work,
                   const SweepFolder& folder, int jobs) {
  const SweepStates states(folder.states(), plan);
  fmt::print("{}: {} runs", plan.name, plan.runs.size());
  if (runs.size() != plan.runs.size()) fmt::print(", {} different ones in this shard", runs.size());
  fmt::print("\n");
  for (const SweepAxis& axis : plan.axes)
    fmt::print("  {:<24}{} values, {} to {}\n", axis.key, axis.values.size(),
               axis.values.front().shown.dump(), axis.values.back().shown.dump());
  const std::size_t shared = std::ranges::count_if(runs, [&](auto* run) { return states.is_shared(*run); });
  fmt::print("  {:<24}{}, from which {} runs start\n", "shared states", states.one_of_each(runs).size(),
             shared);
  fmt::print("  {:<24}{}, {} of them failed\n", "done", work.done, work.failed);
  fmt::print("  {:<24}{}\n", "to do", work.pending.size());
  if (work.pending.empty()) return;
  const double seconds = estimated_seconds(work.pending);
  fmt::print("  {:<24}about {} with {} in parallel, if no run ends before its t_end\n", "time",
             duration_text(seconds / jobs), jobs);
}

void write_slurm(const SweepRequest& request, const SweepPlan& plan, const SweepFolder& folder) {
  require_valid(*request.slurm);
  folder.prepare(plan);
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path file = fs::absolute(request.file), path = fs::absolute(folder.path());
  const fs::path script = path / "sweep.sbatch";
  replace_file(script, slurm_script(program, file, path, *request.slurm));
  fmt::print("With Slurm:\n  sbatch {}\n", shell_quoted(script.string()));
  fmt::print("With GNU parallel:\n  {}\n", parallel_line(program, file, path, *request.slurm));
}

void print_result(const SweepPlan& plan, const Work& work, const Counts& counts, const SweepFolder& folder) {
  fmt::print("{}: {} runs done, {} of them failed; {}\n", plan.name, work.done + counts.done,
             work.failed + counts.failed, folder.path().string());
}

}  // namespace

void sweep(const SweepRequest& request) {
  const SweepPlan plan = read_sweep(request.file);
  const Shard shard = shard_of(request.shard);
  const SweepFolder folder(request.out ? fs::path(*request.out) : fs::path("out") / plan.name);
  if (request.slurm && !request.dry_run) return write_slurm(request, plan, folder);

  if (!request.dry_run) watch_signals();  // first of all: a start takes long where the machine is busy
  const Device device;
  const int jobs = jobs_of(request);
  const auto runs = runs_of(plan, shard);
  for (const SweepRun* run : runs) solver::require_device_memory(run->scene);
  if (request.dry_run) {
    const Work work = work_of(runs, read_records(folder.path()), request);
    print_dry_run(plan, runs, work, folder, jobs_that_fit(jobs, work.pending, request.quiet));
    return;
  }
  folder.prepare(plan);
  const ShardLock lock(folder.lock(shard));
  RecordFile records(folder.records(shard));
  const Records there = read_records(folder.path());
  const Work work = work_of(runs, there, request);
  report_records(there, work, request);
  const int at_once = jobs_that_fit(jobs, work.pending, request.quiet);
  Counts counts;
  try {
    do_members(plan, work.pending, folder, at_once, request.quiet, records, counts);
  } catch (const solver::Interrupted&) {
    throw solver::Interrupted(fmt::format(
        "{}: stopped after {} of {} runs; unfinished runs are saved as checkpoints. Repeat the command to "
        "resume them",
        plan.name, work.done + counts.done, runs.size()));
  }
  print_result(plan, work, counts, folder);
}

void sweep_status(const std::string& path) {
  const SweepTable table = read_table(path);
  for (const auto& line : table.refused) fmt::print(stderr, "myowave: warning: {}\n", line);
  std::map<std::string, std::size_t> outcomes;
  const std::size_t outcome = table.column("outcome");
  for (const auto& row : table.cells) ++outcomes[row[outcome].get<std::string>()];
  fmt::print("{}: {} runs, {} done, {} to do\n", table.plan.name, table.plan.runs.size(), table.cells.size(),
             table.missing);
  for (const auto& [name, count] : outcomes) fmt::print("  {:<12}{}\n", name, count);
  if (table.other_revision > 0)
    fmt::print("  {} of them are of another revision of myowave\n", table.other_revision);
  const auto files = [&](const char* part) {
    std::vector<fs::path> found;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(fs::path(path) / part, none))
      found.push_back(entry.path());
    std::ranges::sort(found);
    return found;
  };
  for (const auto& lock : files("locks"))
    if (const auto owner = ShardLock::owner_of(lock); !owner.empty())
      fmt::print("  {} is being run by {}\n", lock.stem().string(), owner);
  if (const auto saved = files("checkpoints"); !saved.empty())
    fmt::print("  {} started, with checkpoints\n", saved.size());
}

void sweep_table(const std::string& folder, TableFormat format) {
  const SweepTable table = read_table(folder);
  for (const auto& line : table.refused) fmt::print(stderr, "myowave: warning: {}\n", line);
  if (table.missing > 0)
    fmt::print(stderr, "myowave: {} of {} runs are not done and not in the table\n", table.missing,
               table.plan.runs.size());
  if (table.other_revision > 0)
    fmt::print(stderr, "myowave: warning: {} of the runs are of another revision of myowave\n",
               table.other_revision);
  std::cout << (format == TableFormat::csv    ? table_csv(table)
                : format == TableFormat::json ? table_json(table)
                                              : table_text(table));
}

}  // namespace myowave::apps
