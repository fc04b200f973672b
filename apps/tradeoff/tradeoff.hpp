// `myowave tradeoff`: runs a scene with many accuracy settings and compares their cost with their error.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace myowave::apps {

struct TradeoffRequest {
  std::string scene;
  std::string out;
  std::vector<std::string> overrides;  // of all settings
  std::string axes;                    // empty: all dials, with their usual values
  bool product = false;                // all combinations
  std::vector<std::string> targets;
  std::optional<double> budget;  // s of measured runs, after which no setting is started
  int repetitions = 3;
  std::string levels = "2,3,4";
  bool refine_elements = false;  // of the reference, as its grids
  int starts = 3;                // of a chaotic scene's reference
  bool force = false;
};

// Runs the reference and all settings sequentially. Writes the table, its plots and, if there are targets,
// target.toml into the folder.
// Errors: InputError; NumericalFailure where no level of the reference reached its end or no setting meets
// the targets; Interrupted. The measurements so far are in the folder.
void tradeoff(const TradeoffRequest&);

// Prints the dials with their values and the presets.
void list_dials();

}  // namespace myowave::apps
