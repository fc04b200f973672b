// A run as report.html shows it. Missing files are left out.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/draw/plot.hpp"
#include "apps/results/run_results.hpp"

namespace myowave::apps {

// "period" -> "26.8 t.u."
struct Fact {
  std::string what, value;
};

// A value of the effective configuration that is not the default.
struct ChangedParameter {
  std::string key;  // "grid.n"
  nlohmann::json value, by_default;
  std::string unit, doc;
};

struct NamedPlot {
  std::string name;  // of its files: "probes"
  std::string caption;
  Plot plot;
};

class ReportRun {
 public:
  // Errors: InputError if the folder is not that of a run: it has neither manifest.json nor summary.json, or
  // one that cannot be read.
  explicit ReportRun(const std::filesystem::path& folder);

  const std::string& name() const { return name_; }
  const RunResults& results() const { return results_; }
  const nlohmann::json& manifest() const { return manifest_; }
  // The effective configuration; null without a manifest.
  nlohmann::json configuration() const;
  double ms_per_tu() const;
  // Notes on missing or incomplete files.
  const std::vector<std::string>& notes() const { return notes_; }

  // Empty if the run did not write it.
  const CsvTable& tips() const { return tips_; }

  std::vector<Fact> numbers() const;
  std::vector<ChangedParameter> changed_parameters() const;
  std::vector<NamedPlot> plots() const;

 private:
  CsvTable table(const char* file, const std::vector<std::string>& columns, bool expected);

  std::string name_;
  RunResults results_;
  nlohmann::json manifest_;
  std::vector<std::string> notes_;
  CsvTable probes_, tips_, sources_, area_, beats_;
};

// Observables against the one number that differs between the runs; empty where it is not one number.
std::vector<NamedPlot> sweep_plots(const std::vector<ReportRun>&);

}  // namespace myowave::apps
