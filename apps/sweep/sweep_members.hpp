// The runs of a sweep as members of one ensemble.
#pragma once

#include <vector>

#include "apps/sweep/sweep_folder.hpp"
#include "apps/sweep/sweep_progress.hpp"
#include "apps/sweep/sweep_states.hpp"

namespace myowave::apps {

// Does the given runs, `jobs` at once, and appends a record of each. A run whose numerics fail, or whose
// state cannot be made, is a record too. `counts` is kept current. Errors: Interrupted, after the runs under
// way have kept checkpoints, from which the next call goes on; std::runtime_error where the machine fails.
void do_members(const SweepPlan&, const std::vector<const SweepRun*>&, const SweepFolder&, int jobs,
                bool quiet, RecordFile&, Counts& counts);

}  // namespace myowave::apps
