// Runs of the `myowave` command as parallel processes.
//
// A folder of jobs holds the scenes (scenes/NAME.toml), the result folders (runs/NAME) and the output of the
// command (runs/NAME.log). A finished job of the same revision, scene and input states is not repeated.
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
  // As `--set key=value` (apps/input/scene_file.hpp). Errors: InputError if there is no such key.
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
  int status = 0;       // exit status of the run; 128 + n if signal n ended it, -1 if it never started
  std::string message;  // the last line that a failed run printed
  double seconds = 0;   // wall time; 0 if it was reused
  bool reused = false;
  bool ok() const { return status == 0; }
};

// Runs all jobs with `program`, the `myowave` command, at most `parallel` at once, each with its share of the
// machine's threads. After a failed job the others continue, except for those that need its results. Calls
// `report` after each job with its name, its outcome and the number of finished jobs. Errors: InputError if a
// job needs one that is not in the list; std::runtime_error if the system refuses files or processes.
std::map<std::string, JobOutcome> run_jobs(
    const std::filesystem::path& program, std::span<const Job>, const std::filesystem::path& folder,
    int parallel, const std::function<void(const std::string&, const JobOutcome&, std::size_t)>& report);

}  // namespace myowave::apps
