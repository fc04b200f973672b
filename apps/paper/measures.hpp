// What the figures measure on the files of finished runs.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/draw/picture.hpp"
#include "apps/draw/plot.hpp"
#include "apps/paper/recipe.hpp"
#include "apps/report/comparison.hpp"
#include "apps/results/observed.hpp"
#include "apps/results/run_results.hpp"

namespace myowave::apps {

// A spiral turns in 269 ms, the paper's rescaled time.
inline constexpr double rotation_tu = 26.9;
inline constexpr double shipped_dx = 0.6;  // length units; of all scenes of apps/scenes

// The paths of all tips in material coordinates, a gap between one and the next.
Series tip_paths(const RunResults&, std::string name);

// When a tip first came within ten nodes of an edge, t.u.; NaN where none did.
double time_at_edge(const RunResults&);

// Contraction begins at phase number `start` of `starts` of a rigid turn; the first is the shipped state
// itself.
void begin_at_phase(SceneText&, int start, int starts);

// Mean place of the tips from a time on: the core's, where there is one tip and the time is that of whole
// rotations.
Point mean_tip(const RunResults&, double from);

// Mean speed of the core of the longest path, its tip averaged over each rotation from `from` to `to` (t.u.);
// length units/t.u. NaN where there are less than two rotations between.
double core_speed(const RunResults&, double from, double to);

}  // namespace myowave::apps
