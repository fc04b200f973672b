// The table of scalar observables: summary.json, records and tables of sweeps, reports and `myowave tradeoff`
// take names, units and values from it. A new observable is a row here and the code that computes it.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "solver/base/run_output.hpp"

namespace myowave::apps {

// A value times `factor` has the unit `axis`, in which reports plot it. Empty: a number without unit.
struct ObservableUnit {
  std::string_view text, axis;
  double factor = 1;
};

// How `myowave tradeoff` compares a run with its reference.
struct ObservableError {
  enum class Kind { none, relative, absolute, event };  // event: a time that a run need not have
  // Of a chaotic scene: nothing of a single path, or means over several starts, these perhaps only there.
  enum class Chaos { left_out, statistic, statistic_only };

  std::string_view name{}, title{};
  Kind kind = Kind::none;
  Chaos chaos = Chaos::left_out;
};

struct ObservableRow {
  std::string_view path;    // below `observables` in summary.json: "period/mean"
  std::string_view column;  // in the table of a sweep; empty: none
  ObservableUnit unit;
  nlohmann::ordered_json (*get)(const solver::Observables&);  // null where the run has none
  std::string_view curve{};                                   // its title in reports; empty: not plotted
  ObservableError error{};
  bool outcome = false;  // tells how a run ended: sweeps always keep it and show it first

  std::string_view group() const { return path.substr(0, path.find('/')); }  // "period"
};

// In the order of summary.json. Rows of a group stand together.
std::span<const ObservableRow> observable_table();

// Null where there is none at this path.
const ObservableRow* find_observable_row(std::string_view path);

// The groups in their order: "period", "apd", ...
std::vector<std::string_view> observable_groups();

// `observables` of summary.json; a group without any value is null.
nlohmann::ordered_json observables_json(const solver::Observables&);

}  // namespace myowave::apps
