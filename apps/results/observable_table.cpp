#include "apps/results/observable_table.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "apps/base/time_units.hpp"
#include "apps/results/json_number.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;
using O = solver::Observables;
using Error = ObservableError::Kind;
using Chaos = ObservableError::Chaos;
using enum solver::TipEvent;

// ---- getters ------------------------------------------------------------------------------------

// A mean of nothing is none; so is the spread of a single value.
template <auto member>
json mean(const O& o) {
  const solver::MeanSd& m = o.*member;
  return m.n > 0 ? json_number(m.mean) : json();
}

template <auto member>
json sd(const O& o) {
  const solver::MeanSd& m = o.*member;
  return m.n > 1 ? json_number(m.sd) : json();
}

template <auto member>
json count(const O& o) {
  return (o.*member).n;
}

template <auto member>
json number(const O& o) {
  return json_number(o.*member);
}

template <auto member>
json first(const O& o) {
  return o.*member ? json_number((o.*member)->first) : json();
}

template <auto member>
json second(const O& o) {
  return o.*member ? json_number((o.*member)->second) : json();
}

// Of a series of at least two samples.
template <auto member>
json of_tips(const O& o) {
  return o.tips.n > 1 ? json_number(o.tips.*member) : json();
}

template <auto counts, solver::TipEvent event>
json events(const O& o) {
  return (o.trajectories.*counts)[static_cast<std::size_t>(event)];
}

// Of the longest trajectory, if it has a core.
template <class Get>
json of_longest(const O& o, const Get& get) {
  const auto& longest = o.longest_trajectory;
  return longest && longest->core ? json(get(*longest)) : json();
}

template <auto member>
json core(const O& o) {
  return of_longest(o, [](const auto& longest) {
    const auto value = (*longest.core).*member;
    if constexpr (std::is_same_v<decltype(value), const double>)
      return json_number(value);
    else
      return json(value);
  });
}

template <auto member>
json drift(const O& o) {
  return of_longest(
      o, [](const auto& longest) { return longest.drift ? json_number((*longest.drift).*member) : json(); });
}

template <auto member>
json velocity(const O& o) {
  return o.conduction_velocity ? json_number((*o.conduction_velocity).*member) : json();
}

// ---- the table ----------------------------------------------------------------------------------

constexpr ObservableUnit none{"", ""}, time{"t.u.", "ms", to_seconds(1) * 1000}, angle{"rad", "rad"},
    length{"length units", "length units"}, speed{"length units/t.u.", "length units/t.u."},
    rest_area{"of the loaded sheet at rest", "of the rest state"},
    undeformed_length{"of the undeformed length", "%", 100};

using Counts = solver::TrajectoryCounts;
using Core = solver::TipCore;
using Drift = solver::TipDrift;
using Velocity = solver::Quartiles;
using Series = solver::SeriesStatistics;

constexpr ObservableError period_error{"period", "period", Error::relative, Chaos::statistic},
    tips_error{"tips", "mean number of tips", Error::relative, Chaos::statistic_only},
    radius_error{"core_radius", "radius of the core", Error::relative, Chaos::left_out},
    drift_error{"drift", "speed of the drift", Error::absolute, Chaos::left_out},
    breakup_error{"breakup", "time of break-up", Error::event, Chaos::statistic},
    shortening_error{"shortening", "largest shortening", Error::relative, Chaos::statistic};

constexpr auto table = std::to_array<ObservableRow>({
    {"period/mean", "period_mean_tu", time, mean<&O::period>, "period", period_error},
    {"period/sd", "period_sd_tu", time, sd<&O::period>},
    {"period/n", "period_n", none, count<&O::period>},
    {"apd/mean", "apd_mean_tu", time, mean<&O::apd>},
    {"apd/sd", "apd_sd_tu", time, sd<&O::apd>},
    {"apd/n", "apd_n", none, count<&O::apd>},
    {"apd90/mean", "apd90_mean_tu", time, mean<&O::apd90>, "APD90"},
    {"apd90/sd", "apd90_sd_tu", time, sd<&O::apd90>},
    {"apd90/n", "apd90_n", none, count<&O::apd90>},
    {"tips/mean", "tips_mean", none, mean<&O::tips>, "number of tips", tips_error},
    {"tips/sd", "tips_sd", none, sd<&O::tips>},
    {"tips/n", "tips_n", none, count<&O::tips>},
    {"tips/correlation_tu", "tips_correlation_tu", time, number<&O::tips_correlation_tu>},
    {"tips/effective_n", "", none, of_tips<&Series::effective_n>},
    {"tips/standard_error", "tips_standard_error", none, of_tips<&Series::standard_error>},
    {"trajectories/n", "trajectories_n", none, count<&O::trajectories>},
    {"trajectories/born/start", "", none, events<&Counts::born, run>},
    {"trajectories/born/pair", "", none, events<&Counts::born, pair>},
    {"trajectories/born/boundary", "", none, events<&Counts::born, boundary>},
    {"trajectories/born/alone", "", none, events<&Counts::born, alone>},
    {"trajectories/ended/end", "", none, events<&Counts::ended, run>},
    {"trajectories/ended/pair", "", none, events<&Counts::ended, pair>},
    {"trajectories/ended/boundary", "", none, events<&Counts::ended, boundary>},
    {"trajectories/ended/alone", "", none, events<&Counts::ended, alone>},
    {"core/trajectory", "", none,
     [](const O& o) { return of_longest(o, [](const auto& longest) { return longest.number; }); }},
    {"core/x", "core_x", length, core<&Core::x>},
    {"core/y", "core_y", length, core<&Core::y>},
    {"core/radius", "core_radius", length, core<&Core::radius>, "radius of the core", radius_error},
    {"core/rotations", "core_rotations", none, core<&Core::rotations>},
    {"core/drift_speed", "core_drift_speed", speed, drift<&Drift::speed>, "", drift_error},
    {"core/drift_direction", "core_drift_direction", angle, drift<&Drift::direction>},
    {"core/boundary_tu", "core_boundary_tu", time,
     [](const O&
            o) { return of_longest(o, [](const auto& longest) { return json_number(longest.boundary); }); }},
    {"conduction_velocity/median", "conduction_velocity_median", speed, velocity<&Velocity::median>,
     "conduction velocity"},
    {"conduction_velocity/lower_quartile", "conduction_velocity_lower_quartile", speed,
     velocity<&Velocity::lower>},
    {"conduction_velocity/upper_quartile", "conduction_velocity_upper_quartile", speed,
     velocity<&Velocity::upper>},
    {"conduction_velocity/n", "", none,
     [](const O& o) { return o.conduction_velocity ? json(o.conduction_velocity->n) : json(); }},
    {"breakup_tu", "breakup_tu", time, number<&O::breakup_tu>, "", breakup_error, true},
    {"death_tu", "death_tu", time, number<&O::death_tu>, "", {}, true},
    {"area/min", "area_min", rest_area, first<&O::area>, "smallest area"},
    {"area/max", "area_max", rest_area, second<&O::area>},
    {"shortening/max", "shortening_max", undeformed_length, first<&O::shortening>, "largest shortening",
     shortening_error},
    {"shortening/t", "shortening_at_tu", time, second<&O::shortening>},
});

}  // namespace

std::span<const ObservableRow> observable_table() { return table; }

const ObservableRow* find_observable_row(std::string_view path) {
  const auto found = std::ranges::find(table, path, &ObservableRow::path);
  return found == table.end() ? nullptr : &*found;
}

std::vector<std::string_view> observable_groups() {
  std::vector<std::string_view> groups;
  for (const auto& row : table)
    if (groups.empty() || groups.back() != row.group()) groups.push_back(row.group());
  return groups;
}

json observables_json(const O& observables) {
  json all = json::object();
  for (const auto& row : table) all[json::json_pointer('/' + std::string(row.path))] = row.get(observables);
  for (auto& group : all)
    if (group.is_object() && std::ranges::all_of(group, [](const json& one) { return one.is_null(); }))
      group = nullptr;
  return all;
}

}  // namespace myowave::apps
