#include "apps/paper/run_jobs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "apps/base/file_io.hpp"
#include "apps/base/revision.hpp"
#include "apps/input/scene_overrides.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string last_line(const fs::path& path) {
  std::istringstream text(content(path));
  std::string last;
  for (std::string line; std::getline(text, line);)
    if (!line.empty()) last = line;
  return last;
}

// This process's environment ("NAME=value") with an equal share of the machine's threads for each of
// `parallel` runs. Their threads are not bound: all would be bound to the first cores.
std::vector<std::string> environment_of_runs(int parallel) {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::string> variables{fmt::format("OMP_NUM_THREADS={}", std::max(1, cores / parallel)),
                                     "OMP_PROC_BIND=false"};
  for (const char* const* one = environ; *one != nullptr; ++one) {
    const std::string_view variable(*one);
    if (!variable.starts_with("OMP_NUM_THREADS=") && !variable.starts_with("OMP_PROC_BIND="))
      variables.emplace_back(variable);
  }
  return variables;
}

// As execve takes them; valid as long as the words are.
std::vector<const char*> pointers_to(const std::vector<std::string>& words) {
  std::vector<const char*> pointers;
  for (const auto& word : words) pointers.push_back(word.c_str());
  pointers.push_back(nullptr);
  return pointers;
}

// Where the jobs of a folder have their files.
struct JobFiles {
  fs::path scene, run, log;
  JobFiles(const fs::path& folder, const std::string& name)
      : scene(folder / "scenes" / (name + ".toml")),
        run(folder / "runs" / name),
        log(folder / "runs" / (name + ".log")) {}
};

// Its results are there, whole, from the same scene and the same program.
bool is_done(const JobFiles& files, const std::string& scene) {
  if (has_local_changes() || content(files.scene) != scene) return false;
  const auto summary = nlohmann::json::parse(content(files.run / "summary.json"), nullptr, false);
  const auto manifest = nlohmann::json::parse(content(files.run / "manifest.json"), nullptr, false);
  if (summary.is_discarded() || manifest.is_discarded()) return false;
  return summary.contains("failure") && summary["failure"].is_null() &&
         manifest["program"]["git_hash"] == git_revision();
}

// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void become(const char* const* arguments, const char* const* environment, const char* log) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends with its parent, however that ends
#endif
  const int file = open(log, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file >= 0) {
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
  }
  execve(arguments[0], const_cast<char* const*>(arguments), const_cast<char* const*>(environment));
  _exit(127);
}

pid_t start_process(const fs::path& program, const std::vector<std::string>& environment,
                    const JobFiles& files) {
  const std::vector<std::string> words{
      program.string(), "run", files.scene.string(), "--out", files.run.string(), "--force", "--quiet"};
  const auto arguments = pointers_to(words), variables = pointers_to(environment);
  const std::string log = files.log.string();
  const pid_t child = fork();
  if (child == 0) become(arguments.data(), variables.data(), log.c_str());
  if (child < 0) throw std::runtime_error(fmt::format("cannot start a process: {}", std::strerror(errno)));
  return child;
}

class JobQueue {
 public:
  JobQueue(fs::path program, std::span<const Job> jobs, fs::path folder, int parallel,
           const std::function<void(const std::string&, const JobOutcome&, std::size_t)>& report)
      : program_(std::move(program)),
        jobs_(jobs),
        folder_(std::move(folder)),
        parallel_(std::max(1, parallel)),
        environment_(environment_of_runs(parallel_)),
        report_(report) {
    for (const Job& job : jobs_)
      for (const auto& need : job.needs)
        if (std::ranges::find(jobs_, need, &Job::name) == jobs_.end())
          throw solver::InputError(
              fmt::format("job {} needs {}, which is not in the list of jobs", job.name, need));
    fs::create_directories(folder_ / "scenes");
    fs::create_directories(folder_ / "runs");
  }

  std::map<std::string, JobOutcome> run() {
    while (outcomes_.size() < jobs_.size()) {
      const std::size_t before = outcomes_.size();
      for (const Job& job : jobs_)
        if (running_.size() < static_cast<std::size_t>(parallel_)) try_to_start(job);
      if (!running_.empty())
        wait_for_one();
      else if (outcomes_.size() == before)
        throw solver::InputError("jobs that need one another cannot start");
    }
    return std::move(outcomes_);
  }

 private:
  struct Running {
    const Job* job;
    Clock::time_point start;
  };

  void try_to_start(const Job& job) {
    if (outcomes_.contains(job.name) || is_running(job)) return;
    bool reusable = true;
    for (const auto& need : job.needs) {
      const auto outcome = outcomes_.find(need);
      if (outcome == outcomes_.end()) return;
      if (!outcome->second.ok())
        return end(job, {-1, fmt::format("{}, whose result it needs, failed", need), 0, false});
      reusable = reusable && outcome->second.reused;
    }
    const JobFiles files(folder_, job.name);
    if (reusable && is_done(files, job.scene)) return end(job, {0, "", 0, true});
    // First, so that results beside the new scene are never those of an old one.
    fs::remove_all(files.run);
    replace_file(files.scene, job.scene);
    running_.emplace(start_process(program_, environment_, files), Running{&job, Clock::now()});
  }

  bool is_running(const Job& job) const {
    return std::ranges::any_of(running_, [&](const auto& entry) { return entry.second.job == &job; });
  }

  void wait_for_one() {
    int status = 0;
    pid_t child = 0;
    do child = waitpid(-1, &status, 0);
    while (child < 0 && errno == EINTR);
    if (child < 0) throw std::runtime_error(fmt::format("cannot wait for a run: {}", std::strerror(errno)));
    const auto found = running_.find(child);
    if (found == running_.end()) return;
    const auto [job, start] = found->second;
    running_.erase(found);
    JobOutcome outcome;
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (!outcome.ok()) outcome.message = last_line(JobFiles(folder_, job->name).log);
    end(*job, outcome);
  }

  void end(const Job& job, const JobOutcome& outcome) {
    outcomes_[job.name] = outcome;
    report_(job.name, outcome, outcomes_.size());
  }

  fs::path program_;
  std::span<const Job> jobs_;
  fs::path folder_;
  int parallel_;
  std::vector<std::string> environment_;
  const std::function<void(const std::string&, const JobOutcome&, std::size_t)>& report_;
  std::map<pid_t, Running> running_;
  std::map<std::string, JobOutcome> outcomes_;
};

}  // namespace

SceneText& SceneText::set(std::string_view key, std::string_view value) {
  Problems problems("scene");
  SceneTables scene{parse_toml(text_, "scene", problems)};
  apply_override(scene, fmt::format("{}={}", key, value), problems);
  problems.throw_if_any();
  std::ostringstream text;
  text << scene.root << '\n';
  text_ = text.str();
  return *this;
}

std::map<std::string, JobOutcome> run_jobs(
    const fs::path& program, std::span<const Job> jobs, const fs::path& folder, int parallel,
    const std::function<void(const std::string&, const JobOutcome&, std::size_t)>& report) {
  return JobQueue(program, jobs, folder, parallel, report).run();
}

}  // namespace myowave::apps
