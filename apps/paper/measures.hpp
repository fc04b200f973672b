// What the figures measure on the files of finished runs.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/base/time_units.hpp"
#include "apps/draw/picture.hpp"
#include "apps/draw/plot.hpp"
#include "apps/paper/recipe.hpp"
#include "apps/results/observables.hpp"
#include "apps/results/run_results.hpp"
#include "apps/results/sheet_picture.hpp"
#include "solver/analysis/statistics.hpp"

namespace myowave::apps {

// A spiral turns in 26.9 t.u., 269 ms.
inline constexpr double rotation_tu = 26.9;
inline constexpr double shipped_dx = 0.6;  // length units; of all scenes of apps/scenes

std::vector<double> in_seconds(std::vector<double> tu);
std::vector<double> in_ms(std::vector<double> tu);

// "26.85 +- 0.37"; one value: "26.85"; none: "-".
std::string text_of(const solver::MeanSd&, int decimals);
// "n = 144".
std::string count_text(const solver::MeanSd&);
// "+1.2 %" of the paper's number.
std::string relative_difference(double ours, double papers);
// The verdict on a statement of the paper: it holds here too, or not.
std::string verdict(bool holds);

// A row of periods (ms) beside the paper's mean.
Comparison period_row(std::string what, std::string paper, std::span<const double> periods_ms,
                      double papers_mean);
// A row of the difference of two series, a - b (difference_text).
Comparison test_row(std::string what, std::string paper, std::span<const double> a,
                    std::span<const double> b);

// The paths of all tips in material coordinates, a gap between one and the next.
Series tip_paths(const RunResults&, std::string name);

// When a tip first came within ten nodes of an edge, t.u.; NaN where none did.
double time_at_edge(const RunResults&);

// Contraction starts at phase number `start` of `starts` of a rigid turn; the first is the shipped state
// itself.
void begin_at_phase(SceneText&, int start, int starts);

// Mean place of the tips from a time on: the core's, where there is one tip and the time is that of whole
// rotations.
Point mean_tip(const RunResults&, double from);

// Mean speed along the path of the core: of the longest trajectory, its tip averaged over each rotation from
// `from` to `to` (t.u.); length units/t.u. NaN where there are less than two rotations between. The drift in
// trajectories.csv (solver::TipDrift) is the slope of one straight line instead: of a core that follows an
// edge around a corner it means little.
double core_speed(const RunResults&, double from, double to);

}  // namespace myowave::apps
