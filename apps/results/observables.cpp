#include "apps/results/observables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace myowave::apps {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double number_of(const nlohmann::ordered_json& value) {
  return value.is_number() ? value.get<double>() : none;
}

}  // namespace

std::vector<ProbePeriods> periods_of(const RunResults& run, double from) {
  const CsvTable beats = run.csv("beats.csv");
  const auto probe = beats.numbers("probe"), t = beats.numbers("upstroke_tu"),
             period = beats.numbers("period_tu");
  std::vector<ProbePeriods> probes;
  for (std::size_t n = 0; n < t.size(); ++n) {
    const auto p = static_cast<std::size_t>(probe[n]);
    if (probes.size() <= p) probes.resize(p + 1);
    if (t[n] < from || !std::isfinite(period[n])) continue;
    probes[p].t.push_back(t[n]);
    probes[p].period.push_back(period[n]);
  }
  return probes;
}

std::vector<double> all_periods(std::span<const ProbePeriods> probes) {
  std::vector<std::pair<double, double>> all;
  for (const auto& probe : probes)
    for (std::size_t n = 0; n < probe.t.size(); ++n) all.emplace_back(probe.t[n], probe.period[n]);
  std::ranges::sort(all);
  std::vector<double> periods;
  for (const auto& [t, period] : all) periods.push_back(period);
  return periods;
}

double observable(const RunResults& run, std::string_view name) {
  return number_of(run.summary().at("observables").at(std::string(name)));
}

double observable(const RunResults& run, std::string_view name, std::string_view member) {
  const auto& value = run.summary().at("observables").at(std::string(name));
  return value.is_object() ? number_of(value.at(std::string(member))) : none;
}

}  // namespace myowave::apps
