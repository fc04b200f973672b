// `myowave reproduce`: the runs of the chosen figures, then of each figure its data, its picture and its
// numbers beside the paper's.
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

// Makes them in `folder`, `parallel` runs at once (docs of the files: apps/paper/README.md); what is done
// already by this program is kept. Says on the terminal what comes out. Errors: NumericalFailure, after all
// else is made, where a run failed.
void reproduce(std::span<const FigureRecipe>, Extent, const std::filesystem::path& folder, int parallel,
               const std::string& command);

}  // namespace myowave::apps
