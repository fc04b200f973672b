// The scenes that a run goes through, and whether their steps can be taken.
#pragma once

#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// The scenes that a run goes through: its preconditions, then itself. Each goes on from the state of the
// one before.
// Errors: InputError where a precondition contracts a rigid sheet.
std::vector<Scene> stages_of(const Scene&);

// Refuses what is certainly unstable in the scene or a precondition, whatever on_unstable says: dt past the
// bound of the undeformed sheet is a wrong input.
// Errors: InputError with the bound.
void require_stable_step(const Scene&);

}  // namespace myowave::solver
