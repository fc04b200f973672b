#include "apps/sweep/sweep_records.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "apps/base/content_hash.hpp"
#include "apps/base/revision.hpp"
#include "apps/input/schema.hpp"
#include "apps/results/summary_file.hpp"
#include "apps/sweep/sweep_file.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// {"check":"0123456789abcdef",REST; the checksum is that of REST.
constexpr std::string_view before_check = "{\"check\":\"", after_check = "\",";
constexpr std::size_t check_length = 16;

std::string_view checked_part(std::string_view line) {
  const std::size_t end = before_check.size() + check_length;
  const bool complete = line.starts_with(before_check) && line.size() > end + after_check.size() &&
                        line.substr(end, after_check.size()) == after_check;
  return complete ? line.substr(end + after_check.size()) : std::string_view();
}

bool is_intact(std::string_view line) {
  const std::string_view rest = checked_part(line);
  return !rest.empty() && line.substr(before_check.size(), check_length) == content_hash(rest);
}

// Empty if the line is a record.
std::string why_no_record(std::string_view line, json& record) {
  if (!is_intact(line)) return "is damaged: its checksum does not fit";
  record = json::parse(line, nullptr, false);
  const auto is_text = [](const json& parent, const char* key) {
    return parent.is_object() && parent.contains(key) && parent[key].is_string();
  };
  if (!is_text(record, "id") || !record.contains("schema") || !record["schema"].is_number_integer())
    return "is not a record of a sweep";
  if (record["schema"] > sweep_schema)
    return fmt::format("is of a newer myowave (schema {}, here {})", record["schema"].get<int>(),
                       sweep_schema);
  if (!is_text(record, "outcome") || !record.contains("program") || !is_text(record["program"], "git_hash"))
    return "is not a record of a sweep";
  return "";
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error(fmt::format("cannot read {}", path.string()));
  return text;
}

// Higher: better.
int rank(const json& record) { return (failed(record) ? 0 : 2) + (of_this_revision(record) ? 1 : 0); }

void read_file(const fs::path& path, Records& records) {
  const std::string text = text_of(path);
  std::size_t number = 0;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    ++number;
    json record;
    const std::string why = why_no_record(std::string_view(text).substr(begin, end - begin), record);
    if (!why.empty()) {
      records.refused.push_back(
          fmt::format("{}:{}: the line {}; its run counts as not done, and the sweep "
                      "repeats it",
                      path.string(), number, why));
      continue;
    }
    const std::string id = record["id"];
    const auto known = records.by_id.find(id);
    if (known == records.by_id.end() || rank(record) >= rank(known->second))
      records.by_id[id] = std::move(record);
  }
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown host";
}

// What stopped the run. A spiral that broke up can still die.
const char* outcome(const solver::Scene& scene, const solver::RunSummary& summary, bool failure) {
  if (failure) return "failed";
  if (scene.time.stop_on.breakup && summary.observables.breakup_tu) return "breakup";
  if (scene.time.stop_on.death && summary.observables.death_tu) return "death";
  return "end";
}

int open_for_writing(const fs::path& path, int flags) {
  const int file = open(path.c_str(), flags | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0)
    throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
  return file;
}

// The file at the path is the open one.
bool is_in_place(int file, const fs::path& path) {
  struct stat opened {
  }, found{};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &found) == 0 && opened.st_ino == found.st_ino &&
         opened.st_dev == found.st_dev;
}

}  // namespace

std::string Shard::name() const { return fmt::format("shard_{}_of_{}", number, count); }

json record_json(const SweepRun& run, const solver::RunSummary& summary,
                 const std::vector<std::string>& observables, const std::optional<std::string>& failure) {
  const json all = summary_json(summary, run.scene.mechanics.has_value(), failure);
  json selected = json::object();
  for (const auto& name : observables) selected[name] = all["observables"][name];
  return {
      {"schema", sweep_schema},
      {"id", run.id},
      {"program", {{"version", version()}, {"git_hash", git_revision()}, {"git_dirty", has_local_changes()}}},
      {"outcome", outcome(run.scene, summary, failure.has_value())},
      {"failure", all["failure"]},
      {"t", all["t"]},
      {"steps", all["steps"]},
      {"observables", std::move(selected)},
      {"mechanics", all["mechanics"]},
      {"substeps", all["substeps"]},
      {"warnings", all["warnings"]},
      {"cost",
       {{"wall_s", all["wall_s"]},
        {"precondition_s", summary.precondition_s},
        {"cell_steps_per_s", all["throughput"]["cell_steps_per_s"]},
        {"phases", all["phases"]}}},
      {"configuration", effective_configuration(run.scene)}};
}

std::string record_line(const json& record) {
  const std::string rest = record.dump(-1, ' ', false, json::error_handler_t::replace).substr(1);
  return fmt::format("{}{}{}{}\n", before_check, content_hash(rest), after_check, rest);
}

Records read_records(const fs::path& sweep_folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(sweep_folder / "records", none))
    if (entry.path().extension() == ".jsonl") files.push_back(entry.path());
  std::ranges::sort(files);
  Records records;
  for (const auto& path : files) read_file(path, records);
  return records;
}

bool failed(const json& record) { return record["outcome"] == "failed"; }

bool of_this_revision(const json& record) { return record["program"]["git_hash"] == git_revision(); }

// ---- the lock ---------------------------------------------------------------------------------

namespace {

// owner_of() holds the lock for an instant.
bool locks(int file) {
  for (int tries = 0; tries < 20; ++tries) {
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace

ShardLock::ShardLock(const fs::path& path) : file_(open_for_writing(path, O_RDWR)) {
  if (!locks(file_) || !is_in_place(file_, path)) {
    close(file_);
    throw std::runtime_error(fmt::format(
        "{} is locked: this shard is being run by {}; wait for it or end it, or run another shard",
        path.string(), text_of(path)));
  }
  const std::string owner = fmt::format("process {} on {} since {:%Y-%m-%dT%H:%M:%SZ}", getpid(), host_name(),
                                        fmt::gmtime(std::time(nullptr)));
  // For the messages of other processes only; the system holds the lock itself.
  if (ftruncate(file_, 0) != 0 || pwrite(file_, owner.data(), owner.size(), 0) < 0) {
    const int error = errno;
    close(file_);
    throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
  }
}

ShardLock::~ShardLock() { close(file_); }

std::string ShardLock::owner_of(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return "";
  const bool held = flock(file, LOCK_SH | LOCK_NB) != 0;
  close(file);
  return held ? text_of(path) : "";
}

// ---- the file ---------------------------------------------------------------------------------

RecordFile::RecordFile(fs::path path) : path_(std::move(path)), file_(open_for_writing(path_, O_RDWR)) {
  const std::string text = text_of(path_);
  const auto last = text.rfind('\n');
  const std::size_t whole = last == std::string::npos ? 0 : last + 1;
  if (ftruncate(file_, off_t(whole)) == 0 && lseek(file_, 0, SEEK_END) == off_t(whole)) return;
  const int error = errno;
  close(file_);
  throw std::runtime_error(fmt::format("cannot write {}: {}", path_.string(), std::strerror(error)));
}

RecordFile::~RecordFile() { close(file_); }

void RecordFile::append(const json& record) {
  require_in_place();
  const std::string line = record_line(record);
  const off_t before = lseek(file_, 0, SEEK_END);
  const ssize_t written = write(file_, line.data(), line.size());
  const bool whole = written == ssize_t(line.size());
  if (whole && fdatasync(file_) == 0) return;
  const int error = written >= 0 && !whole ? ENOSPC : errno;
  if (ftruncate(file_, before) != 0) refuse("a partial line cannot be removed");
  refuse(std::strerror(error));
}

void RecordFile::require_in_place() const {
  // Writes into a removed file are lost without an error.
  if (!is_in_place(file_, path_)) refuse("the file was removed while the sweep ran");
}

void RecordFile::refuse(const std::string& reason) const {
  throw std::runtime_error(fmt::format(
      "cannot write {}: {}. Earlier records are intact: mend this and repeat the command to resume",
      path_.string(), reason));
}

}  // namespace myowave::apps
