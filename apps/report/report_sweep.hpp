// Pairs and plots of a sweep, for its report.
#pragma once

#include <string>
#include <vector>

#include "apps/report/report_run.hpp"
#include "apps/sweep/sweep_table.hpp"

namespace myowave::apps {

// Pairs from the same state: in how many the other run broke up later than the reference, not at all, or
// earlier. Undecided if neither broke up while both ran.
struct PairCount {
  int later = 0, never = 0, earlier = 0, undecided = 0, missing = 0;
  std::vector<double> delays;  // t.u., of the pairs that both broke up

  int decided() const { return later + never + earlier; }
};

// All pairs, or those with equal values on the axes besides that of the curves and that of the pairs; `what`
// names these values.
struct PairRow {
  std::string what;
  PairCount count;
};

// A row for each combination of those axes, and one of all. Empty if the sweep has no pairs.
std::vector<PairRow> pair_rows(const SweepTable&);

// First break-up, and each observable, over the number axis that has the most values; a plot, or a curve, for
// each combination of the others. Seeds are averaged. Empty where no axis has numbers.
std::vector<NamedPlot> sweep_plots(const SweepTable&);

// "reference" and "other", in words: rigid, contracting.
std::vector<std::string> pair_names(const SweepTable&);

}  // namespace myowave::apps
