// Sweep files: TOML in, the validated list of runs out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/sweep/sweep_axis.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

// Runs that differ on one axis only are pairs: `other` is compared with `reference`.
struct SweepPairs {
  std::size_t axis = 0;
  std::size_t reference = 0, other = 1;  // numbers of the values on that axis
};

struct SweepRun {
  std::vector<std::size_t> at;  // the number of its value on each axis
  std::string id;               // content hash of what its results depend on
  solver::Scene scene;
};

struct SweepPlan {
  std::string name;  // of the file
  std::string text;  // as it was read
  std::vector<SweepAxis> axes;
  std::vector<SweepRun> runs;  // in the order of tables; the last axis is the fastest
  std::optional<SweepPairs> pairs;
  std::vector<std::string> observables;  // kept in the records, by their names in summary.json
  bool folders = false;                  // each run leaves its folder too
};

// Errors, of both: InputError with one line for each thing that is wrong, "file:line:column: message"; a
// value that makes no valid scene is named by its number on its axis.
SweepPlan read_sweep(const std::filesystem::path& file);
// For text that is at hand; `file` gives the name in messages and the folder that paths start from.
SweepPlan parse_sweep(std::string_view text, const std::filesystem::path& file);

// The content hash of everything that the results of the scene depend on: its effective configuration without
// what is only shown, and the bytes of the file that it starts from in place of that file's name.
std::string run_id(const solver::Scene&);

}  // namespace myowave::apps
