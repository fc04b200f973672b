// The folder of a sweep: its paths and its sweep.json.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/sweep_file.hpp"
#include "apps/sweep/sweep_records.hpp"

namespace myowave::apps {

// The plan that sweep.json stores for tables and reports.
struct StoredPlan {
  struct StoredAxis {
    std::string key;
    std::vector<nlohmann::ordered_json> values;  // as tables show them
  };
  struct StoredRun {
    std::string id;
    std::vector<std::size_t> at;  // the number of its value on each axis
  };
  std::string name;
  std::vector<StoredAxis> axes;
  std::vector<StoredRun> runs;
  std::optional<SweepPairs> pairs;
  std::vector<std::string> observables;
};

class SweepFolder {
 public:
  explicit SweepFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path states() const { return path_ / "states"; }
  std::filesystem::path checkpoints(const std::string& id) const { return path_ / "checkpoints" / id; }
  std::filesystem::path run_folder(const std::string& id) const { return path_ / "runs" / id; }
  std::filesystem::path records(const Shard&) const;
  std::filesystem::path lock(const Shard&) const;

  // Makes the folder, and writes sweep.json where it is not that of the plan.
  // Errors: InputError where the folder holds something else or cannot be made; std::runtime_error "cannot
  // write FILE: reason".
  void prepare(const SweepPlan&) const;

  bool is_sweep() const;
  // Errors: InputError where there is no sweep.json, or one that cannot be read.
  StoredPlan plan() const;

 private:
  std::filesystem::path path_;
};

}  // namespace myowave::apps
