#include "apps/paper/recipe.hpp"

#include <fmt/format.h>

#include <array>

#include "apps/base/embedded_files.hpp"
#include "apps/paper/figures.hpp"

namespace myowave::apps {

std::span<const FigureRecipe> figure_recipes() {
  static constexpr std::array<FigureRecipe, 13> recipes{{
      {"1", "fig01_cell", "The cell model with its authors' parameters", single_cell_jobs, make_single_cell},
      {"2", "fig02_uniform_pacing", "Uniform pacing: potential, shortening, tension; restitution",
       uniform_pacing_jobs, make_uniform_pacing},
      {"3", "fig03_radial_waves", "Waves from a stimulus in the middle", radial_wave_jobs, make_radial_wave},
      {"4", "fig04_spiral_wave", "A spiral wave", spiral_wave_jobs, make_spiral_wave},
      {"5", "fig05_area_histograms", "Areas of rows of elements", area_histogram_jobs, make_area_histograms},
      {"6", "fig06_total_area", "Area of the sheet", total_area_jobs, make_total_area},
      {"7", "fig07_tip_trajectories", "Tip trajectories", tip_trajectory_jobs, make_tip_trajectories},
      {"8", "fig08_spiral_periods", "Periods of the spiral", spiral_period_jobs, make_spiral_periods},
      {"9", "fig09_turbulence", "Break-up at mu1 = 0.07", turbulence_jobs, make_turbulent_patterns},
      {"10", "fig10_turbulence_statistics", "Periods and sources of turbulence", turbulence_jobs,
       make_turbulence_statistics},
      {"11", "fig11_first_breakup", "First break-up", first_breakup_jobs, make_first_breakup},
      {"size", "beyond_sheet_size", "Beyond the paper: size of the sheet and boundary condition",
       sheet_size_jobs, make_sheet_sizes},
      {"tension", "beyond_tension_law", "Beyond the paper: law of the tension and sign of the load",
       tension_law_jobs, make_tension_laws},
  }};
  return recipes;
}

SceneText shipped_scene(std::string_view name) {
  return SceneText(embedded_file(fmt::format("{}.toml", name)));
}

}  // namespace myowave::apps
