#include "apps/summary_file.hpp"

#include <cmath>

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json number(const std::optional<double>& value) { return value ? number(*value) : json(nullptr); }

// A mean of nothing is none; so is the spread of a single value.
json mean(const solver::MeanSd& m) { return m.n > 0 ? number(m.mean) : json(nullptr); }
json sd(const solver::MeanSd& m) { return m.n > 1 ? number(m.sd) : json(nullptr); }

json mean_sd_n(const solver::MeanSd& m) { return {{"mean", mean(m)}, {"sd", sd(m)}, {"n", m.n}}; }

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

json observables(const solver::Observables& o) {
  return {{"period", mean_sd_n(o.period)},      {"apd", mean_sd_n(o.apd)},
          {"apd90", mean_sd_n(o.apd90)},        {"tips", {{"mean", mean(o.tips)}, {"sd", sd(o.tips)}}},
          {"breakup_tu", number(o.breakup_tu)}, {"death_tu", number(o.death_tu)},
          {"area", pair(o.area, "min", "max")}, {"shortening", pair(o.shortening, "max", "t")}};
}

}  // namespace

json summary_json(const solver::RunSummary& summary, bool deforms,
                  const std::optional<std::string>& failure) {
  const auto& phases = summary.phases;
  return {{"model", summary.plan.in_words()},
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
          {"throughput", {{"cell_steps_per_s", number(summary.cell_steps_per_s)}}},
          {"mechanics", deforms ? mechanics(summary.mechanics) : json(nullptr)},
          {"observables", observables(summary.observables)}};
}

}  // namespace myowave::apps
