// The runs of a sweep as members of one ensemble.
#pragma once

#include <vector>

#include "apps/sweep/sweep_folder.hpp"
#include "apps/sweep/sweep_progress.hpp"
#include "apps/sweep/sweep_states.hpp"

namespace myowave::apps {

// Runs the given members, `jobs` in parallel, and appends a record of each, also if its numerics or its
// initial state fail. Updates `counts`. Errors: Interrupted, after unfinished runs have saved checkpoints,
// from which the next call resumes; std::runtime_error if the machine fails.
void do_members(const SweepPlan&, const std::vector<const SweepRun*>&, const SweepFolder&, int jobs,
                bool quiet, RecordFile&, Counts& counts);

}  // namespace myowave::apps
