// The files of `myowave stability`: NAME.csv and NAME.svg of each map, and stability.json.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "solver/studies/stability_maps.hpp"

namespace myowave::apps {

// The map of that name, or all for "".
// Errors: InputError with the nearest name.
std::vector<solver::StabilityMap> choose_maps(const std::string& name);

// Columns "name [unit]", then outcome and handled; a row a run.
std::string map_csv(const solver::MapTable&);

// {tried, not_handled, maps: [{name, caption, tried, not_handled, outcomes: {name: count}}]}
nlohmann::ordered_json stability_json(std::span<const solver::MapTable>);

// Makes the maps sequentially, writes the files of each as soon as it is done, and prints its
// counts and findings. Replaces the results of an earlier call and leaves all else in the folder.
// Errors: InputError where the folder cannot be made; NumericalFailure, after everything is written,
// where a run returned a wrong result without an error or a warning.
void write_maps(const std::vector<solver::StabilityMap>&, const std::filesystem::path& folder);

}  // namespace myowave::apps
