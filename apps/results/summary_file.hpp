// summary.json: what a run did and found; its keys are a contract (apps/results/README.md).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "solver/base/run_output.hpp"

namespace myowave::apps {

// The event at the start or end of a trajectory, as files name it. `with_run`: the word for the start or
// end of the run.
const char* event_name(solver::TipEvent, const char* with_run);

// Keys keep the order they are written in. A missing value is null; nan and inf never appear. `deforms`:
// false leaves `mechanics` null.
nlohmann::ordered_json summary_json(const solver::RunSummary&, bool deforms,
                                    const std::optional<std::string>& failure);

}  // namespace myowave::apps
