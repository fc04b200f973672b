// The records of a sweep: what each finished run found, a JSON line a run, in a file a shard.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

struct SweepRun;

// Part `number` of `count`, from 1: every count-th run.
struct Shard {
  std::size_t number = 1, count = 1;
  std::string name() const;  // "shard_1_of_1"
  bool has(std::size_t run) const { return run % count == number - 1; }
};

// The layout of records, and of sweep.json.
inline constexpr int sweep_schema = 1;

// Record of a finished or failed run with the given observables.
nlohmann::ordered_json record_json(const SweepRun&, const solver::RunSummary&,
                                   const std::vector<std::string>& observables,
                                   const std::optional<std::string>& failure);

// With checksum and newline.
std::string record_line(const nlohmann::ordered_json&);

struct Records {
  // By id. Duplicate records: prefer the successful one, then that of this revision, then the newest.
  std::map<std::string, nlohmann::ordered_json> by_id;
  // Invalid lines, with file, line number and what to do.
  std::vector<std::string> refused;
};

// The complete records of all shards. An incomplete last line, which a kill leaves, is skipped without a
// warning. Errors: std::runtime_error if a file cannot be read.
Records read_records(const std::filesystem::path& sweep_folder);

bool failed(const nlohmann::ordered_json& record);
bool of_this_revision(const nlohmann::ordered_json& record);

// A lock on a shard. The system releases it when the process ends, however it ends.
class ShardLock {
 public:
  // Errors: std::runtime_error with the owner of the lock, or with the reason why the file cannot be written.
  explicit ShardLock(const std::filesystem::path& file);
  ~ShardLock();
  ShardLock(const ShardLock&) = delete;
  ShardLock& operator=(const ShardLock&) = delete;

  // Process and host of the owner; empty if the lock is free.
  static std::string owner_of(const std::filesystem::path& file);

 private:
  int file_;
};

// The records of one shard, for the process that holds its lock.
class RecordFile {
 public:
  // Cuts off an incomplete last line.
  // Errors, also of append: std::runtime_error "cannot write FILE: reason"; earlier records are intact.
  explicit RecordFile(std::filesystem::path);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  // On the disk when this returns.
  void append(const nlohmann::ordered_json& record);

 private:
  [[noreturn]] void refuse(const std::string& reason) const;
  void require_in_place() const;

  std::filesystem::path path_;
  int file_;
};

}  // namespace myowave::apps
