// A sweep that is killed, stopped, out of disk space or without its folder: no reported record is lost, the
// errors say what to do, and the final table is that of an uninterrupted sweep.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

constexpr int stopped_on_request = 75;
constexpr int runs = 10;

// Rigid and contracting, a shared precondition, and checkpoints along the way.
constexpr const char* sweep_text = R"(
[stop]
on = ["breakup", "death"]
t_end = 40

[scene.grid]
n = 61
[scene.mechanics]
[scene.output]
period_from = 0
checkpoint_every = 4
[scene.initial]
type = "broken_front"
precondition = { duration = 20, mu1 = 0.15 }

[[axis]]
key = "mechanics.on"
values = [false, true]

[[axis]]
key = "excitation.mu1"
min = 0.1
max = 0.14
num = 5
)";

class SweepFaults : public testing::Test {
 protected:
  SweepFaults() {
    setenv("XDG_CACHE_HOME", MYOWAVE_TEST_CACHE, 1);
    std::ofstream(folder_ / "small.toml") << sweep_text;
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::vector<std::string> arguments(const std::string& out, std::vector<std::string> further = {}) const {
    std::vector<std::string> all{"sweep", path("small.toml"), "--out", out, "--jobs", "2"};
    all.insert(all.end(), further.begin(), further.end());
    return all;
  }

  Outcome sweep(const std::string& name, std::vector<std::string> further = {}) const {
    return run_myowave(arguments(path(name), std::move(further)));
  }

  // By run, without times, places and speeds.
  static json reproducible(const std::string& out) {
    const Outcome outcome = run_myowave({"sweep", "table", out, "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    json rows = json::parse(outcome.output)["rows"];
    for (json& row : rows)
      for (auto cell = row.begin(); cell != row.end();)
        cell = cell.key().starts_with("wall") || cell.key().starts_with("cell_steps") ? row.erase(cell)
                                                                                      : std::next(cell);
    return rows;
  }

  // Results of an uninterrupted sweep; computed once.
  const json& undisturbed() {
    static const json rows = [&] {
      EXPECT_EQ(sweep("undisturbed").status, 0);
      return reproducible(path("undisturbed"));
    }();
    return rows;
  }

  // Seconds of such a sweep.
  double duration() {
    static const double seconds = [&] {
      const auto start = std::chrono::steady_clock::now();
      EXPECT_EQ(sweep("timed").status, 0);
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }();
    return seconds;
  }

  // Ids of the whole records of all shards.
  std::set<std::string> recorded(const std::string& name) const {
    std::set<std::string> ids;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder_ / name / "records", none)) {
      std::istringstream lines(read_text(entry.path()));
      for (std::string line; std::getline(lines, line) && !lines.eof();)
        ids.insert(json::parse(line)["id"].get<std::string>());
    }
    return ids;
  }

  void expect_whole(const std::string& name) {
    const Outcome outcome = sweep(name);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(undisturbed().size(), std::size_t(runs));
    EXPECT_EQ(reproducible(path(name)), undisturbed());
  }

  // Kills sweeps at random times until there were `kills` kills; a finished sweep is started again from
  // nothing.
  void survives_kills(int kills) {
    std::mt19937_64 engine(2004);
    const auto uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
    const double whole = duration();
    int killed = 0, sweeps = 0;
    while (killed < kills) {
      const std::string name = fmt::format("killed_{}", sweeps++);
      std::set<std::string> before;
      while (killed < kills) {
        Process process(arguments(path(name), {"--quiet"}), folder_ / "errors");
        if (const auto status = process.wait_for(std::chrono::duration<double>(0.7 * whole * uniform()))) {
          EXPECT_EQ(*status, 0) << process.errors();
          break;
        }
        process.send(SIGKILL);
        const int status = process.wait();
        if (status == 0) break;  // it ended just before
        EXPECT_EQ(status, -SIGKILL);
        ++killed;
        const auto after = recorded(name);
        EXPECT_TRUE(std::ranges::includes(after, before)) << "a record is lost";
        before = after;
      }
      expect_whole(name);
    }
    RecordProperty("kills", killed);
    RecordProperty("sweeps", sweeps);
  }

  TemporaryFolder folder_;
};

TEST_F(SweepFaults, KilledAtRandomInstants) { survives_kills(50); }

TEST_F(SweepFaults, StoppedBySignals) {
  for (const int signal : {SIGTERM, SIGUSR1, SIGINT}) {
    SCOPED_TRACE(signal);
    const std::string name = fmt::format("stopped_{}", signal);
    // Each time some work is done before the stop, so that the sweep ends.
    int stops = 0;
    for (int status = stopped_on_request; status == stopped_on_request; ++stops) {
      // It handles signals before it takes the lock.
      const fs::path lock = folder_ / name / "locks/shard_1_of_1.lock";
      fs::remove(lock);
      Process process(arguments(path(name), {"--quiet"}), folder_ / "errors");
      ASSERT_TRUE(Process::waits_until_there(lock));
      status = process.wait_for(std::chrono::duration<double>(0.2 * duration())).value_or(-1);
      if (status != -1) {
        EXPECT_EQ(status, 0) << process.errors();
        break;
      }
      process.send(signal);
      status = process.wait();
      EXPECT_THAT(status, AnyOf(0, stopped_on_request)) << process.errors();
      if (status == stopped_on_request) {
        EXPECT_THAT(process.errors(), HasSubstr("Repeat the command to resume them"));
      }
      ASSERT_LT(stops, 100);
    }
    EXPECT_GE(stops, 1);
    expect_whole(name);
  }
}

TEST_F(SweepFaults, ASecondInterruptEndsAtOnce) {
  Process process(arguments(path("interrupted"), {"--quiet"}), folder_ / "errors");
  ASSERT_TRUE(Process::waits_until_there(folder_ / "interrupted/records/shard_1_of_1.jsonl"));
  process.send(SIGSTOP);  // both come before it can end by the first
  process.send(SIGINT);
  process.send(SIGCONT);
  // The handler has run when the signal is no longer pending.
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  process.send(SIGINT);
  EXPECT_THAT(process.wait(), AnyOf(-SIGINT, stopped_on_request));
  expect_whole("interrupted");
}

TEST_F(SweepFaults, ASecondProcessOnTheShardIsRefused) {
  Process first(arguments(path("shared"), {"--quiet"}), folder_ / "errors");
  ASSERT_TRUE(Process::waits_until_there(folder_ / "shared/records/shard_1_of_1.jsonl"));
  first.send(SIGSTOP);  // the second waits a little, and must not see the end of the first
  const Outcome second = sweep("shared");
  first.send(SIGCONT);
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.errors, AllOf(HasSubstr("shard_1_of_1"), HasSubstr(fmt::format("{}", first.id()))));
  EXPECT_EQ(first.wait(), 0) << first.errors();
  expect_whole("shared");
}

TEST_F(SweepFaults, ShardsAtOnceMakeOneTable) {
  std::vector<std::unique_ptr<Process>> shards;
  for (int n = 1; n <= 3; ++n)
    shards.push_back(std::make_unique<Process>(arguments(path("shards"), {"--shard", fmt::format("{}/3", n)}),
                                               folder_ / fmt::format("errors_{}", n)));
  shards[1]->wait_for(std::chrono::duration<double>(0.3 * duration()));
  shards[1]->send(SIGKILL);
  EXPECT_EQ(shards[0]->wait(), 0) << shards[0]->errors();
  EXPECT_EQ(shards[2]->wait(), 0) << shards[2]->errors();
  EXPECT_THAT(shards[1]->wait(), AnyOf(-SIGKILL, 0));
  EXPECT_EQ(sweep("shards", {"--shard", "2/3"}).status, 0);
  EXPECT_EQ(reproducible(path("shards")), undisturbed());
}

// A file that cannot grow, as on a full disk.
TEST_F(SweepFaults, AFullDiskLosesNothing) {
  const std::string program = MYOWAVE_EXECUTABLE;
  for (const int blocks : {1, 2, 3, 6, 20}) {  // of 512 bytes or 1 KiB, as the shell has it
    SCOPED_TRACE(blocks);
    const std::string name = fmt::format("full_{}", blocks);
    std::string line = fmt::format("trap '' XFSZ; ulimit -f {}; exec '{}'", blocks, program);
    for (const auto& argument : arguments(path(name), {"--quiet"})) line += " '" + argument + "'";
    Process process({"-c", line}, folder_ / "errors", "sh");
    const int status = process.wait();
    if (status != 0) {
      EXPECT_EQ(status, 1) << process.errors();
      EXPECT_THAT(process.errors(), AllOf(HasSubstr(path(name)), HasSubstr("File too large")));
    }
    const auto before = recorded(name);
    expect_whole(name);
    EXPECT_TRUE(std::ranges::includes(recorded(name), before));
  }
}

// Needs to mount: root, or a user namespace.
TEST_F(SweepFaults, ASmallDiskAndOneThatIsReadOnly) {
  const std::string program = MYOWAVE_EXECUTABLE;
  const std::string disk = path("disk");
  fs::create_directory(disk);
  const auto inside = [&](const std::string& script) {
    Process process({"-rm", "sh", "-c", script}, folder_ / "errors", "unshare");
    const int status = process.wait();
    return std::pair{status, process.errors()};
  };
  if (inside("mount -t tmpfs -o size=16k tmpfs '" + disk + "'").first != 0)
    GTEST_SKIP() << "no file system can be mounted here";
  std::string command = "'" + program + "'";
  for (const auto& argument : arguments(disk + "/sweep", {"--quiet"})) command += " '" + argument + "'";
  const auto [full, told] = inside(fmt::format(
      "mount -t tmpfs -o size=24k tmpfs '{0}' && {1}; status=$?; cp -r '{0}/sweep' '{2}'; exit $status", disk,
      command, path("kept")));
  EXPECT_EQ(full, 1) << told;
  EXPECT_THAT(told, AllOf(HasSubstr(disk), HasSubstr("No space left on device")));
  expect_whole("kept");

  const auto [refused, why] = inside(fmt::format("mount -t tmpfs -o ro tmpfs '{}' && {}", disk, command));
  EXPECT_THAT(refused, AnyOf(1, 2)) << why;
  EXPECT_THAT(why, AllOf(HasSubstr(disk), HasSubstr("Read-only file system")));
}

TEST_F(SweepFaults, AFolderRemovedMeanwhileIsReported) {
  Process process(arguments(path("removed"), {"--quiet"}), folder_ / "errors");
  ASSERT_TRUE(Process::waits_until_there(folder_ / "removed/records/shard_1_of_1.jsonl"));
  for (int n = 0; n < 100 && fs::exists(folder_ / "removed"); ++n) {
    std::error_code busy;
    fs::remove_all(folder_ / "removed", busy);
  }
  const int status = process.wait();
  if (status == 0) GTEST_SKIP() << "it finished before its folder was removed";
  EXPECT_EQ(status, 1);
  EXPECT_THAT(process.errors(), HasSubstr(path("removed")));
  expect_whole("removed");
}

TEST_F(SweepFaults, DamagedRecordsAreReportedAndRunAgain) {
  ASSERT_EQ(sweep("damaged").status, 0);
  const fs::path file = folder_ / "damaged/records/shard_1_of_1.jsonl";
  std::vector<std::string> lines;
  std::istringstream text(read_text(file));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), std::size_t(runs));
  lines[2][lines[2].size() / 2] ^= 1;  // a flipped bit
  lines[4] = "{\"run\": 7}";           // of another program
  lines[5] = std::regex_replace(lines[5], std::regex("\"schema\":\\d+"), "\"schema\":99");
  std::ofstream out(file, std::ios::binary);
  for (std::size_t n = 0; n + 1 < lines.size(); ++n) out << lines[n] << '\n';
  out << lines.back().substr(0, lines.back().size() / 3);  // cut short by a kill
  out.close();
  const Outcome outcome = sweep("damaged");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  for (const int line : {3, 5, 6})
    EXPECT_THAT(outcome.errors, HasSubstr(fmt::format("{}:{}", file.string(), line)));
  EXPECT_EQ(reproducible(path("damaged")), undisturbed());
}

TEST_F(SweepFaults, DamagedCheckpointsAreReportedAndNotUsed) {
  const auto checkpoints = [&] {
    std::vector<fs::path> files;
    std::error_code gone;  // members may finish meanwhile and remove theirs
    for (fs::recursive_directory_iterator entry(folder_ / "hurt/checkpoints", gone), end;
         !gone && entry != end; entry.increment(gone))
      if (entry->is_regular_file(gone)) files.push_back(entry->path());
    return files;
  };
  // A stop between two members leaves none.
  for (int tries = 0; checkpoints().empty() && tries < 50; ++tries) {
    fs::remove_all(folder_ / "hurt");
    Process process(arguments(path("hurt"), {"--quiet"}), folder_ / "errors");
    ASSERT_TRUE(Process::waits_until_there(folder_ / "hurt/records/shard_1_of_1.jsonl"));
    process.send(SIGTERM);
    EXPECT_THAT(process.wait(), AnyOf(0, stopped_on_request)) << process.errors();
  }
  ASSERT_FALSE(checkpoints().empty());
  for (const fs::path& file : checkpoints()) {
    std::string content = read_text(file);
    content[content.size() / 2] ^= 4;
    std::ofstream(file, std::ios::binary) << content;
  }
  const Outcome outcome = sweep("hurt");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("its content is damaged"));
  EXPECT_EQ(reproducible(path("hurt")), undisturbed());
}

// Setting the clock changes no result, because only texts for people use it.
TEST(Clock, IsReadForPeopleOnly) {
  const std::regex clock("system_clock|gettimeofday|std::time\\(|CLOCK_REALTIME|last_write_time");
  std::set<std::string> found;
  for (const char* folder : {"apps", "solver", "kernels"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(MYOWAVE_SOURCE_DIR) / folder))
      if (entry.is_regular_file() && std::regex_search(read_text(entry.path()), clock))
        found.insert(entry.path().filename().string());
  EXPECT_THAT(found, testing::IsSubsetOf({"manifest.cpp", "reproduce.cpp", "sweep_records.cpp"}));
}

}  // namespace
}  // namespace myowave::test
