// What each subcommand of `myowave` does. Errors leave as exceptions; apps/cli/main.cpp turns them into
// messages and exit status.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace myowave::apps {

struct RunRequest {
  std::string scene;
  std::optional<std::string> out;  // absent: out/<scene name> in the working directory
  std::optional<double> until;     // t.u., in place of time.t_end
  std::vector<std::string> overrides;
  std::optional<std::string> resume;  // result folder of a run to go on with; nothing else is given then
  bool force = false;
  bool quiet = false;
};

// Errors: InputError; NumericalFailure, Interrupted, after what was computed is on disk.
void run(const RunRequest&);

// Says what the scene models and what it leaves out, the memory and the time it takes. Leaves nothing behind.
// Errors: InputError.
void check(const std::string& scene, const std::vector<std::string>& overrides);

// Errors: InputError for a section that does not exist.
void describe(const std::string& section, bool markdown);

struct StabilityRequest {
  std::string map;                    // empty: all
  std::string out = "out/stability";  // relative to the working directory
  bool force = false;
};

// Errors: InputError; NumericalFailure, after everything is on disk, where a wrong result passed silently.
void stability(const StabilityRequest&);

// The names of all maps, a line each with what it shows.
std::string map_names();

struct ReproduceRequest {
  std::vector<std::string> figures;  // numbers, or "all"
  bool quick = false;
  std::string out = "out/reproduce";  // relative to the working directory
  int jobs = 0;                       // runs at once; 0: one a core, or one where a device computes
};

// Errors: InputError; NumericalFailure, after all that could be made is on disk, where a run failed.
void reproduce(const ReproduceRequest&);

// The numbers of all figures, a line each with what it shows.
std::string figure_names();

void info();

}  // namespace myowave::apps
