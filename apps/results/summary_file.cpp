#include "apps/results/summary_file.hpp"

#include "apps/results/json_number.hpp"
#include "apps/results/observable_table.hpp"
#include "solver/run/make_plan.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

json mechanics(const solver::MechanicsStatistics& m) {
  return {{"solves", m.solves},
          {"left_out", m.left_out},
          {"newton_iterations", m.newton_iterations},
          {"newton_max", m.newton_max},
          {"factorizations", m.factorizations},
          {"shifts", m.shifts},
          {"not_elliptic", m.not_elliptic},
          {"min_J", json_number(m.min_J)}};
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
      {"t", json_number(summary.t)},
      {"failure", failure ? json(*failure) : json(nullptr)},
      {"warnings", summary.warnings},
      {"substeps", {{"steps", summary.substepped_steps}, {"largest", summary.largest_substeps}}},
      {"phases",
       {{"excitation", json_number(phases.excitation)},
        {"transfer", json_number(phases.transfer)},
        {"mechanics", json_number(phases.mechanics)},
        {"observe", json_number(phases.observe)},
        {"output", json_number(phases.output)}}},
      {"wall_s", json_number(summary.wall_s)},
      {"memory",
       {{"planned_bytes", memory(solver::views_of(summary.plan))}, {"most_bytes", memory(summary.memory)}}},
      {"throughput", {{"cell_steps_per_s", json_number(summary.cell_steps_per_s)}}},
      {"mechanics", deforms ? mechanics(summary.mechanics) : json(nullptr)},
      {"observables", observables_json(summary.observables)}};
}

}  // namespace myowave::apps
