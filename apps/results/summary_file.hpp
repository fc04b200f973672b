// summary.json: what a run did and found; its keys are a contract (apps/results/README.md).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "solver/base/run_output.hpp"

namespace myowave::apps {

// What begins or ends a trajectory, as the files say it; `with_run`: of what the run begins or ends.
const char* event_name(solver::TipEvent, const char* with_run);

// Keys keep the order they are written in. null stands where there is nothing to tell; nan and inf
// never appear. `deforms`: false leaves `mechanics` null.
nlohmann::ordered_json summary_json(const solver::RunSummary&, bool deforms,
                                    const std::optional<std::string>& failure);

}  // namespace myowave::apps
