// The scenes that a run goes through, and whether their steps can be taken.
#pragma once

#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// The scenes that a run goes through: its preconditions, then itself. Each starts from the final state of the
// previous one.
// Errors: InputError if a precondition contracts a rigid sheet.
std::vector<Scene> stages_of(const Scene&);

// Refuses a scene or precondition that is certainly unstable, whatever on_unstable is: dt above the bound of
// the undeformed sheet is an input error. Errors: InputError with the bound.
void require_stable_step(const Scene&);

}  // namespace myowave::solver
