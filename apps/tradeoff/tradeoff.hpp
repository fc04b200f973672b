// `myowave tradeoff`: a scene over its dials of accuracy, each setting's cost against its error.
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
  std::optional<double> budget;  // s of measured runs, after which no setting is begun
  int repetitions = 3;
  std::string levels = "2,3,4";
  bool refine_elements = false;  // of the reference, as its grids
  int starts = 3;                // of a chaotic scene's reference
  bool force = false;
};

// Runs the reference and all settings one after the other and leaves the table, its plots and, where there
// are targets, target.toml in the folder.
// Errors: InputError; NumericalFailure where no level of the reference came to its end or no setting meets
// the targets; Interrupted. What was measured until then is in the folder.
void tradeoff(const TradeoffRequest&);

// Prints the dials with their values and the presets.
void list_dials();

}  // namespace myowave::apps
