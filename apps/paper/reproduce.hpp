// `myowave reproduce`: runs the scenes of the chosen figures, then writes the data, the picture and the
// numbers of each figure beside those of the paper.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/paper/recipe.hpp"

namespace myowave::apps {

// The recipes of these numbers in the paper's order; of all for "all".
// Errors: InputError with the nearest number.
std::vector<FigureRecipe> choose_figures(const std::vector<std::string>& numbers);

// The data of all curves: panel, series, x, y, error.
std::string figure_csv(const Figure&);

// Makes the figures in `folder` with `parallel` runs at once (files: apps/paper/README.md). Reuses finished
// runs of the same revision. Prints the results. Errors: NumericalFailure if a run failed, after everything
// else is made.
void reproduce(std::span<const FigureRecipe>, Extent, const std::filesystem::path& folder, int parallel,
               const std::string& command);

}  // namespace myowave::apps
