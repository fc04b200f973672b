// Initial states that follow from a formula.
#pragma once

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Initial state of `rest` and `broken_front`; the other types come from apps (files, cache).
// Errors: InputError for the other types.
InitialState make_initial_state(const Scene&);

}  // namespace myowave::solver
