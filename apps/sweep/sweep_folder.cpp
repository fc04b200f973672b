#include "apps/sweep/sweep_folder.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "apps/base/file_io.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;
using solver::InputError;

json plan_json(const SweepPlan& plan) {
  json axes = json::array(), runs = json::array();
  for (const SweepAxis& axis : plan.axes) {
    json values = json::array();
    for (const AxisValue& value : axis.values) values.push_back(value.shown);
    axes.push_back({{"key", axis.key}, {"values", std::move(values)}});
  }
  for (const SweepRun& run : plan.runs) runs.push_back({{"id", run.id}, {"at", run.at}});
  json pairs;
  if (plan.pairs)
    pairs = {{"axis", plan.pairs->axis}, {"reference", plan.pairs->reference}, {"other", plan.pairs->other}};
  return {{"schema", sweep_schema},  {"name", plan.name}, {"sweep", plan.text},
          {"axes", std::move(axes)}, {"pairs", pairs},    {"observables", plan.observables},
          {"runs", std::move(runs)}};
}

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

StoredPlan plan_of(const json& stored) {
  StoredPlan plan{.name = stored.at("name"),
                  .axes = {},
                  .runs = {},
                  .pairs = {},
                  .observables = stored.at("observables").get<std::vector<std::string>>()};
  for (const auto& axis : stored.at("axes"))
    plan.axes.push_back({axis.at("key"), axis.at("values").get<std::vector<nlohmann::ordered_json>>()});
  for (const auto& run : stored.at("runs")) plan.runs.push_back({run.at("id"), run.at("at")});
  for (const auto& run : plan.runs) {
    if (run.at.size() != plan.axes.size()) throw std::out_of_range("a run has not one value an axis");
    for (std::size_t n = 0; n < run.at.size(); ++n)
      if (run.at[n] >= plan.axes[n].values.size())
        throw std::out_of_range("a run has a value that its axis lacks");
  }
  const json& pairs = stored.at("pairs");
  if (!pairs.is_null())
    plan.pairs = {.axis = pairs.at("axis"), .reference = pairs.at("reference"), .other = pairs.at("other")};
  return plan;
}

}  // namespace

fs::path SweepFolder::records(const Shard& shard) const {
  return path_ / "records" / (shard.name() + ".jsonl");
}

fs::path SweepFolder::lock(const Shard& shard) const { return path_ / "locks" / (shard.name() + ".lock"); }

bool SweepFolder::is_sweep() const { return fs::exists(path_ / "sweep.json"); }

void SweepFolder::prepare(const SweepPlan& plan) const {
  try {
    if (fs::exists(path_) && !fs::is_directory(path_))
      throw InputError(
          fmt::format("{} is a file; a sweep needs a folder: choose another with --out", path_.string()));
    // A sweep killed at its start leaves folders without sweep.json.
    const bool started = fs::is_directory(path_ / "records");
    if (fs::exists(path_) && !fs::is_empty(path_) && !is_sweep() && !started)
      throw InputError(fmt::format("{} holds something else than a sweep: choose another folder with --out",
                                   path_.string()));
    for (const char* part : {"records", "locks", "states"}) fs::create_directories(path_ / part);
  } catch (const fs::filesystem_error& error) {
    throw InputError(
        fmt::format("cannot make the sweep's folder {}: {}", path_.string(), error.code().message()));
  }
  const std::string text = plan_json(plan).dump() + '\n';
  if (content(path_ / "sweep.json") != text) replace_file(path_ / "sweep.json", text);
}

StoredPlan SweepFolder::plan() const {
  const fs::path file = path_ / "sweep.json";
  if (!is_sweep())
    throw InputError(
        fmt::format("{} is not the folder of a sweep: there is no sweep.json in it", path_.string()));
  try {
    const json stored = json::parse(content(file));
    if (stored.at("schema") > sweep_schema)
      throw InputError(fmt::format("{}: is of a newer myowave (schema {}, here {})", file.string(),
                                   stored.at("schema").get<int>(), sweep_schema));
    return plan_of(stored);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}; `myowave sweep` with the sweep file and --out {} writes it again",
                                 file.string(), error.what(), path_.string()));
  }
}

}  // namespace myowave::apps
