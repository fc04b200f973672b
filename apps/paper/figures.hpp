// The two functions of each figure: its runs, and the figure made from them (apps/paper/recipe.hpp).
#pragma once

#include <vector>

#include "apps/paper/recipe.hpp"

namespace myowave::apps {

// Fig 1
std::vector<Job> single_cell_jobs(Extent);
MadeFigure make_single_cell(const Runs&, Extent);
// Fig 2
std::vector<Job> uniform_pacing_jobs(Extent);
MadeFigure make_uniform_pacing(const Runs&, Extent);
// Figs 3 and 4
std::vector<Job> radial_wave_jobs(Extent);
MadeFigure make_radial_wave(const Runs&, Extent);
std::vector<Job> spiral_wave_jobs(Extent);
MadeFigure make_spiral_wave(const Runs&, Extent);
// Figs 5 and 6
std::vector<Job> area_histogram_jobs(Extent);
MadeFigure make_area_histograms(const Runs&, Extent);
std::vector<Job> total_area_jobs(Extent);
MadeFigure make_total_area(const Runs&, Extent);
// Figs 7 and 8
std::vector<Job> tip_trajectory_jobs(Extent);
MadeFigure make_tip_trajectories(const Runs&, Extent);
std::vector<Job> spiral_period_jobs(Extent);
MadeFigure make_spiral_periods(const Runs&, Extent);
// Figs 9 and 10
std::vector<Job> turbulence_jobs(Extent);
MadeFigure make_turbulent_patterns(const Runs&, Extent);
MadeFigure make_turbulence_statistics(const Runs&, Extent);
// Fig 11
std::vector<Job> first_breakup_jobs(Extent);
MadeFigure make_first_breakup(const Runs&, Extent);
// Beyond the paper
std::vector<Job> sheet_size_jobs(Extent);
MadeFigure make_sheet_sizes(const Runs&, Extent);
std::vector<Job> tension_law_jobs(Extent);
MadeFigure make_tension_laws(const Runs&, Extent);

}  // namespace myowave::apps
