// The files and the table of `myowave tradeoff`.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/tradeoff/tradeoff_errors.hpp"

namespace myowave::apps {

// A setting and its results.
struct Trial {
  Setting setting;
  std::optional<solver::Scene> scene{};              // empty: refused
  std::string trouble{};                             // why it was refused, failed or left out
  std::vector<double> wall_s{}, cell_steps_per_s{};  // a repetition each
  std::vector<Measures> runs{};                      // from each start of a chaotic scene, else one
  Errors errors{};
};

struct ReferenceRun {
  int k = 0;  // nodes a grid.dx
  std::vector<std::string> overrides{};
  double wall_s = 0;
  std::string trouble{};  // why it failed
};

struct Study {
  std::string command;
  solver::Scene own;  // as the file and --set give it, on grid.dx
  std::vector<ReferenceRun> reference_runs{};
  std::optional<Reference> reference{};
  std::vector<Trial> trials{};
  std::string stopped{};  // why it is incomplete
};

// Of the wall seconds or rates of a trial; nan where it was not run.
double median(std::vector<double> values);

// By the name of the observable, of each trial. An error counts as no less than its uncertainty.
std::map<std::string, std::vector<bool>, std::less<>> fronts_of(const Study&);

// Removes the files of an earlier study.
void remove_tradeoff(const std::filesystem::path& folder);

// tradeoff.csv, tradeoff.json, error_NAME.png and .svg, index.html; documented in apps/tradeoff/README.md.
// Errors: std::runtime_error "cannot write FILE: reason".
void write_tradeoff(const Study&, const std::filesystem::path& folder);

// On the terminal, the cheapest first.
void print_tradeoff(const Study&);

}  // namespace myowave::apps
