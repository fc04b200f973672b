// Many runs of the `myowave` command, each a process of its own, as many at once as there are cores.
//
// A folder of jobs holds scenes/NAME.toml, which `myowave run` takes as it is, and runs/NAME, what it
// left there, with what it said in runs/NAME.log. A job that was done by this very program, from the
// same scene and the same states of others, is not done again.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace myowave::apps {

// A scene file from another one and values in place of its own.
class SceneText {
 public:
  explicit SceneText(std::string_view toml) : text_(toml) {}
  // As `--set key=value` (apps/input/scene_file.hpp). Errors: InputError where that leads nowhere.
  SceneText& set(std::string_view key, std::string_view value);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct Job {
  std::string name;
  std::string scene;               // TOML
  std::vector<std::string> needs;  // jobs whose results the scene reads, as ../runs/NAME/fields.h5
};

struct JobOutcome {
  int status = 0;       // exit status of the run; 128 + n where signal n ended it, -1 where it never began
  std::string message;  // the last line that a failed run said
  double seconds = 0;   // wall time; 0 where it was done before
  bool reused = false;
  bool ok() const { return status == 0; }
};

// Runs all with `program`, the `myowave` command, at most `parallel` at once, each with its share of the
// machine's threads. A job that fails ends neither the others nor this function; those that need it are not
// begun. `told`, after each job: its name, what came of it, how many are done. Errors: InputError where a job
// needs one that is not in the list; std::runtime_error where the system refuses files or processes.
std::map<std::string, JobOutcome> run_jobs(
    const std::filesystem::path& program, std::span<const Job>, const std::filesystem::path& folder,
    int parallel, const std::function<void(const std::string&, const JobOutcome&, std::size_t)>& told);

}  // namespace myowave::apps
