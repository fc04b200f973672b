// How a figure of the paper is reproduced: its runs, its plots, and its numbers beside those of the paper.
//
// A run is a scene of apps/scenes with some values of its own, a job of apps/paper/run_jobs.hpp. Figures
// share runs: jobs of one name are the same.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/draw/plot.hpp"
#include "apps/paper/run_jobs.hpp"
#include "apps/results/run_results.hpp"

namespace myowave::apps {

// One number of the paper beside ours.
struct Comparison {
  std::string what;
  std::string paper;  // or of an independent program; empty if neither gives it
  std::string ours{};
  std::string difference{};  // in words or per cent; empty where there is nothing to compare with
  std::string samples{};     // what the number is a mean of
  std::string why{};         // of a difference: the experiment that shows its cause
};

struct MadeFigure {
  std::string caption;
  Figure figure;
  std::vector<Comparison> rows{};
};

// How much is computed: all, or as much as shows each figure in a fraction of the time.
enum class Extent { full, quick };

// The results of finished runs, by the names of their jobs.
class Runs {
 public:
  explicit Runs(std::filesystem::path folder) : folder_(std::move(folder)) {}
  // Errors: InputError where the run is not there.
  RunResults operator[](std::string_view job) const { return RunResults(folder_ / job); }

 private:
  std::filesystem::path folder_;
};

struct FigureRecipe {
  std::string_view number;  // of the paper's figure; a word for a page beyond the paper
  std::string_view name;    // of the files
  std::string_view title;
  std::vector<Job> (*jobs)(Extent);
  MadeFigure (*make)(const Runs&, Extent);
};

// In the paper's order, then the pages beyond it.
std::span<const FigureRecipe> figure_recipes();

// A scene of apps/scenes by its file name without ".toml".
SceneText shipped_scene(std::string_view name);

}  // namespace myowave::apps
