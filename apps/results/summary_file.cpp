#include "apps/results/summary_file.hpp"

#include <cmath>

#include "solver/run/make_plan.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json number(const std::optional<double>& value) { return value ? number(*value) : json(nullptr); }

// A mean of nothing is none; so is the spread of a single value.
json mean(const solver::MeanSd& m) { return m.n > 0 ? number(m.mean) : json(nullptr); }
json sd(const solver::MeanSd& m) { return m.n > 1 ? number(m.sd) : json(nullptr); }

json mean_sd_n(const solver::MeanSd& m) { return {{"mean", mean(m)}, {"sd", sd(m)}, {"n", m.n}}; }

json conduction_velocity(const std::optional<solver::Quartiles>& v) {
  if (!v) return nullptr;
  return {{"median", number(v->median)},
          {"lower_quartile", number(v->lower)},
          {"upper_quartile", number(v->upper)},
          {"n", v->n}};
}

json pair(const std::optional<std::pair<double, double>>& values, const char* first, const char* second) {
  if (!values) return nullptr;
  return {{first, number(values->first)}, {second, number(values->second)}};
}

json mechanics(const solver::MechanicsStatistics& m) {
  return {{"solves", m.solves},
          {"left_out", m.left_out},
          {"newton_iterations", m.newton_iterations},
          {"newton_max", m.newton_max},
          {"factorizations", m.factorizations},
          {"shifts", m.shifts},
          {"not_elliptic", m.not_elliptic},
          {"min_J", number(m.min_J)}};
}

json plan(const solver::Plan& all) {
  json parts = json::array();
  for (const auto& part : all.parts) {
    parts.push_back({{"part", part.part},
                     {"active", part.active},
                     {"what", part.what},
                     {"why", part.why},
                     {"bytes", part.bytes()}});
  }
  return parts;
}

json memory(const std::vector<solver::SpaceBytes>& spaces) {
  if (spaces.empty()) return nullptr;
  json bytes = json::object();
  for (const auto& [space, most] : spaces) bytes[space] = most;
  return bytes;
}

json tips(const solver::SeriesStatistics& tips, const std::optional<double>& correlation_tu) {
  const bool any = tips.n > 1;
  return {{"mean", mean(tips)},
          {"sd", sd(tips)},
          {"n", tips.n},
          {"correlation_tu", number(correlation_tu)},
          {"effective_n", any ? number(tips.effective_n) : json(nullptr)},
          {"standard_error", any ? number(tips.standard_error) : json(nullptr)}};
}

json events(const std::array<std::int64_t, 4>& counts, const char* with_run) {
  json result;
  using enum solver::TipEvent;
  for (const auto event : {run, pair, boundary, alone})
    result[event_name(event, with_run)] = counts[static_cast<std::size_t>(event)];
  return result;
}

json trajectories(const solver::TrajectoryCounts& counts) {
  return {{"n", counts.n}, {"born", events(counts.born, "start")}, {"ended", events(counts.ended, "end")}};
}

// Of the longest trajectory.
json core(const std::optional<solver::TipTrajectory>& longest) {
  if (!longest || !longest->core) return nullptr;
  const auto& [x, y, radius, rotations] = *longest->core;
  const auto& drift = longest->drift;
  return {{"trajectory", longest->number},
          {"x", number(x)},
          {"y", number(y)},
          {"radius", number(radius)},
          {"rotations", rotations},
          {"drift_speed", drift ? number(drift->speed) : json(nullptr)},
          {"drift_direction", drift ? number(drift->direction) : json(nullptr)},
          {"boundary_tu", number(longest->boundary)}};
}

json observables(const solver::Observables& o) {
  return {{"period", mean_sd_n(o.period)},
          {"apd", mean_sd_n(o.apd)},
          {"apd90", mean_sd_n(o.apd90)},
          {"tips", tips(o.tips, o.tips_correlation_tu)},
          {"trajectories", trajectories(o.trajectories)},
          {"core", core(o.longest_trajectory)},
          {"conduction_velocity", conduction_velocity(o.conduction_velocity)},
          {"breakup_tu", number(o.breakup_tu)},
          {"death_tu", number(o.death_tu)},
          {"area", pair(o.area, "min", "max")},
          {"shortening", pair(o.shortening, "max", "t")}};
}

}  // namespace

const char* event_name(solver::TipEvent event, const char* with_run) {
  switch (event) {
    case solver::TipEvent::run:
      return with_run;
    case solver::TipEvent::pair:
      return "pair";
    case solver::TipEvent::boundary:
      return "boundary";
    case solver::TipEvent::alone:
      break;
  }
  return "alone";
}

json summary_json(const solver::RunSummary& summary, bool deforms,
                  const std::optional<std::string>& failure) {
  const auto& phases = summary.phases;
  return {
      {"model", summary.plan.in_words()},
      {"plan", plan(summary.plan)},
      {"steps", summary.steps},
      {"t", number(summary.t)},
      {"failure", failure ? json(*failure) : json(nullptr)},
      {"warnings", summary.warnings},
      {"substeps", {{"steps", summary.substepped_steps}, {"largest", summary.largest_substeps}}},
      {"phases",
       {{"excitation", number(phases.excitation)},
        {"transfer", number(phases.transfer)},
        {"mechanics", number(phases.mechanics)},
        {"observe", number(phases.observe)},
        {"output", number(phases.output)}}},
      {"wall_s", number(summary.wall_s)},
      {"memory",
       {{"planned_bytes", memory(solver::views_of(summary.plan))}, {"most_bytes", memory(summary.memory)}}},
      {"throughput", {{"cell_steps_per_s", number(summary.cell_steps_per_s)}}},
      {"mechanics", deforms ? mechanics(summary.mechanics) : json(nullptr)},
      {"observables", observables(summary.observables)}};
}

}  // namespace myowave::apps
