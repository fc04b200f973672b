// Numbers and series of a finished run.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "apps/results/run_results.hpp"

namespace myowave::apps {

// Periods at one probe: each between two upstrokes, at the time of the first.
struct ProbePeriods {
  std::vector<double> t, period;  // t.u.
};
// Of each probe in beats.csv, upstrokes at `from` (t.u.) and later.
std::vector<ProbePeriods> periods_of(const RunResults&, double from);
// Of all probes in the order of time, so that what one probe and another see of the same wave stands
// together.
std::vector<double> all_periods(std::span<const ProbePeriods>);

// The number that summary.json has under these names, NaN where it is null.
double observable(const RunResults&, std::string_view name);
double observable(const RunResults&, std::string_view name, std::string_view member);

}  // namespace myowave::apps
