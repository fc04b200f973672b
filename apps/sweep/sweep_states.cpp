#include "apps/sweep/sweep_states.hpp"

#include <fstream>
#include <mutex>
#include <set>

#include "apps/base/content_hash.hpp"
#include "apps/base/file_io.hpp"
#include "apps/input/initial_state.hpp"
#include "apps/input/schema.hpp"
#include "apps/input/state_cache.hpp"
#include "solver/run/stages.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::json;

// HDF5 is not thread-safe.
std::mutex& hdf5() {
  static std::mutex mutex;
  return mutex;
}

// Ta is always computed, so that a contracting run and its rigid partner, which needs no Ta, start from one
// state.
solver::Scene with_tension(solver::Scene scene) {
  scene.output.tension = true;
  return scene;
}

// Results of the preconditions besides their state.
json notes_json(const solver::RunSummary& summary) {
  return {{"substepped_steps", summary.substepped_steps},
          {"largest_substeps", summary.largest_substeps},
          {"warnings", summary.warnings}};
}

bool read_notes(const fs::path& path, solver::RunSummary& summary) {
  std::ifstream file(path);
  const json notes = json::parse(file, nullptr, false);
  if (!notes.is_object() || notes.size() != notes_json(summary).size()) return false;
  summary.substepped_steps = notes["substepped_steps"];
  summary.largest_substeps = notes["largest_substeps"];
  summary.warnings = notes["warnings"];
  return true;
}

}  // namespace

std::string state_definition(const solver::Scene& given) {
  const solver::Scene scene = with_tension(given);
  json definition = json::array();
  for (const solver::Scene& stage : solver::stages_of(scene)) {
    json one = effective_configuration(stage);
    one.erase("initial");
    one.erase("stimulus");
    one["time"].erase("ms_per_tu");
    for (const char* shown : {"frames", "fields", "element_areas", "probes", "maps", "period_from"})
      one["output"].erase(shown);
    definition.push_back(std::move(one));
  }
  json initial = effective_configuration(scene)["initial"];
  initial.erase("precondition");
  if (scene.initial.type == solver::InitialSettings::Type::file)
    initial["file"] = content_hash_of_file(scene.initial.file);
  definition.back() = std::move(initial);  // in the place of the scene itself
  return definition.dump();
}

SweepStates::SweepStates(fs::path folder, const SweepPlan& plan) : folder_(std::move(folder)) {
  std::map<std::string, std::set<std::string>> runs_of;
  for (const SweepRun& run : plan.runs)
    if (!run.scene.initial.preconditions.empty()) runs_of[state_definition(run.scene)].insert(run.id);
  for (const auto& [definition, runs] : runs_of)
    if (runs.size() > 1)
      for (const auto& id : runs) definition_of_[id] = definition;
}

bool SweepStates::is_shared(const SweepRun& run) const { return definition_of_.contains(run.id); }

std::vector<const SweepRun*> SweepStates::one_of_each(const std::vector<const SweepRun*>& runs) const {
  std::vector<const SweepRun*> result;
  std::set<std::string> seen;
  for (const SweepRun* run : runs)
    if (is_shared(*run) && seen.insert(definition_of_.at(run->id)).second) result.push_back(run);
  return result;
}

solver::InitialState SweepStates::shared(const SweepRun& run, solver::OutputSink& sink,
                                         solver::RunSummary& summary,
                                         const solver::RunControl& control) const {
  const std::string& definition = definition_of_.at(run.id);
  const std::string hash = content_hash(definition);
  const fs::path path = folder_ / (hash + ".h5"), notes = folder_ / (hash + ".json");
  {
    const std::lock_guard lock(hdf5());
    auto found = find_state(path, definition);
    if (found && read_notes(notes, summary)) return *std::move(found);
  }
  const solver::Scene scene = with_tension(run.scene);
  solver::InitialState state = solver::run_preconditions(scene, initial(run, sink), sink, summary, control);
  replace_file(notes, notes_json(summary).dump() + '\n');
  const std::lock_guard lock(hdf5());
  keep_state(path, definition, state);
  return state;
}

solver::InitialState SweepStates::initial(const SweepRun& run, solver::OutputSink& sink) {
  const std::lock_guard lock(hdf5());
  return resolve_initial_state(run.scene, sink);
}

}  // namespace myowave::apps
