// Initial states that come from files or from the user's cache.
#pragma once

#include <optional>

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

// V, r and, where there, Ta of the last frame of a fields.h5 (or of plain 2-D datasets), or the
// part of it that starts at `window` = [row0, column0].
// Errors: InputError that names the file and what is wrong (missing, not HDF5, dataset, shape).
solver::InitialState read_state(const std::string& file, int rows, int columns,
                                const std::optional<std::array<int, 2>>& window);

// Whether a settled spiral can be had on the scene's sheet with its core where the scene wants it.
// Errors: InputError that says why not.
void require_settled_spiral(const solver::Scene&);

// The run that makes the scene's settled spiral; empty where the cache holds it already, or the scene starts
// from something else.
std::optional<solver::Scene> spiral_to_settle(const solver::Scene&);

// The scene's initial state, whatever its type, with its noise. A settled spiral is computed once
// (`progress` is told) and kept in the user's cache by content hash.
solver::InitialState resolve_initial_state(const solver::Scene&, solver::OutputSink& progress);

}  // namespace myowave::apps
