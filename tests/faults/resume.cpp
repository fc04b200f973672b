// The command stopped by signals, killed, or with damaged files: it can be resumed, and its results are those
// of an uninterrupted run.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/base/hdf5_handle.hpp"
#include "tests/support/command.hpp"
#include "tests/support/process.hpp"
#include "tests/support/sheets.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;

constexpr int stopped_on_request = 75;

std::string values_of_hdf5(const fs::path& path) {
  std::string values;
  const apps::Hdf5Handle file = apps::open_hdf5(path);
  for (const char* name : {"time", "V", "r", "Ta", "nodes", "grid", "activation", "first_activation",
                           "period", "period_sd", "apd", "beats", "conduction_velocity"}) {
    if (H5Lexists(file, name, H5P_DEFAULT) <= 0) continue;
    const auto dataset = apps::open_dataset(file, name);
    std::size_t size = 1;
    for (const auto extent : dataset.size) size *= extent;
    std::vector<double> numbers(size);
    EXPECT_GE(H5Dread(dataset.id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
    values += fmt::format("{} {}\n", name, fmt::join(dataset.size, " "));
    values.append(reinterpret_cast<const char*>(numbers.data()), size * sizeof(double));
  }
  return values;
}

std::string summary_without_measurements(const fs::path& path) {
  auto summary = nlohmann::json::parse(read_text(path));
  for (const char* key : {"phases", "wall_s", "throughput", "memory"}) summary.erase(key);
  return summary.dump(1);
}

// The part of each file of a run's folder that is the same in every run of the scene.
std::map<std::string, std::string> results(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const auto name = fs::relative(entry.path(), folder).string();
    if (name == "manifest.json") {
      content[name] = "";  // when and where
    } else if (name == "summary.json") {
      content[name] = summary_without_measurements(entry.path());
    } else {
      content[name] =
          entry.path().extension() == ".h5" ? values_of_hdf5(entry.path()) : read_text(entry.path());
    }
  }
  return content;
}

void expect_same(const std::map<std::string, std::string>& actual,
                 const std::map<std::string, std::string>& expected) {
  for (const auto& [name, content] : expected) {
    const auto found = actual.find(name);
    if (found == actual.end()) {
      ADD_FAILURE() << name << " is missing";
    } else if (name.ends_with(".h5") || name.ends_with(".png")) {
      EXPECT_TRUE(found->second == content) << name;
    } else {
      EXPECT_EQ(found->second, content) << name;
    }
  }
  for (const auto& [name, content] : actual) EXPECT_TRUE(expected.contains(name)) << name << " is too many";
}

// A run of some tenths of a second, with every output.
const std::string sheet = R"(
[grid]
n = 41
[time]
t_end = 16
[initial]
type = "broken_front"
[output]
every = 1
tips_every = 0.2
probes_every = 0.2
checkpoint_every = 0.6
probes = [[20, 20], [40, 30]]
period_from = 0
frames = true
fields = true
maps = true
)";
const std::string contracting = sheet + "element_areas = true\n[mechanics]\ninterval = 35\n";

class ResumedCommand : public testing::Test {
 protected:
  // In a memory file system if there is one: written data outlive the process as on a disk, without waiting
  // for the disk.
  static void SetUpTestSuite() {
    if (access("/dev/shm", W_OK) == 0) setenv("TMPDIR", "/dev/shm", 1);
  }

  TemporaryFolder folder;
  fs::path scene = folder / "scene.toml", whole = folder / "whole", out = folder / "out";
  fs::path told = folder / "told.txt";

  void write_scene(const std::string& text) const { std::ofstream(scene) << text; }

  std::map<std::string, std::string> undisturbed() const {
    const auto outcome = run_myowave({"run", scene.string(), "--out", whole.string(), "--force", "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return results(whole);
  }

  Process begin() const { return {{"run", scene.string(), "--out", out.string(), "--quiet"}, told}; }
  Process go_on() const { return {{"run", "--resume", out.string(), "--quiet"}, told}; }

  void expect_ends(const std::map<std::string, std::string>& expected) const {
    Process rest = go_on();
    EXPECT_EQ(rest.wait(), 0) << rest.errors();
    expect_same(results(out), expected);
  }

  fs::path checkpoint(const char* turn) const {
    return out / "checkpoints" / fmt::format("checkpoint_{}", turn);
  }

  // Stopped when the second checkpoint exists. The newest is the one of the stop.
  void stop_on_the_way() const {
    Process first = begin();
    ASSERT_TRUE(first.waits_until_there(checkpoint("odd")));
    first.send(SIGTERM);
    ASSERT_EQ(first.wait(), stopped_on_request) << first.errors();
  }
};

TEST_F(ResumedCommand, StoppedBySignalsIsTheUninterruptedRun) {
  for (const auto& text : {sheet, contracting}) {
    write_scene(text);
    const auto expected = undisturbed();
    EXPECT_GT(expected.size(), 25U);
    fs::remove_all(out);
    // A signal each time the file of tips has grown by this many bytes.
    std::uintmax_t bytes = 100;
    int parts = 0;
    for (int status = stopped_on_request; status != 0; ++parts, bytes += 60) {
      Process part = parts == 0 ? begin() : go_on();
      constexpr std::array signals{SIGTERM, SIGUSR1, SIGINT};
      if (bytes < expected.at("sources.csv").size() && part.waits_until_there(out / "sources.csv", bytes))
        part.send(signals[parts % signals.size()]);
      status = part.wait();
      ASSERT_TRUE(status == 0 || status == stopped_on_request) << status << part.errors();
      if (status == 0) break;
      EXPECT_THAT(part.errors(), HasSubstr("stopped at t = "));
      EXPECT_THAT(part.errors(), HasSubstr("myowave run --resume " + out.string()));
    }
    expect_same(results(out), expected);
    const auto again = run_myowave({"run", "--resume", out.string()});
    EXPECT_EQ(again.status, 0);
    EXPECT_THAT(again.output, HasSubstr("is finished"));
  }
}

TEST_F(ResumedCommand, IsStoppedAtOnceByASecondInterrupt) {
  write_scene(sheet);
  // A run that does not end by itself during the test, and seldom checks for signals.
  Process run(
      {"run", scene.string(), "--out", out.string(), "--quiet", "--until", "1e6", "--set", "grid.n=401"},
      told);
  ASSERT_TRUE(run.waits_until_there(out / "sources.csv", 40));
  run.send(SIGINT), run.send(SIGINT);
  std::this_thread::sleep_for(milliseconds(5));
  run.send(SIGINT);
  const int status = run.wait();
  EXPECT_TRUE(status == -SIGINT || status == stopped_on_request) << status;
}

// Kills at random times of a run with a checkpoint every few milliseconds. A run killed before its first
// checkpoint starts again; all others resume.
TEST_F(ResumedCommand, KilledAtAnyInstantLosesNothing) {
  constexpr int kills = 25;  // of each scene
  Uniform random(7);
  for (const auto& text : {sheet, contracting}) {
    write_scene(text);
    const auto start = std::chrono::steady_clock::now();
    const auto expected = undisturbed();
    const auto whole_time =
        std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - start);
    fs::remove_all(out);
    int ended = 0, gone_on = 0;
    for (int killed = 0; killed < kills;) {
      const bool kept = fs::exists(checkpoint("even")) || fs::exists(checkpoint("odd"));
      if (!kept) fs::remove_all(out);
      Process part = kept ? go_on() : begin();
      std::this_thread::sleep_for(whole_time * random(0.02, 0.6));
      part.send(SIGKILL);
      const int status = part.wait();
      ASSERT_TRUE(status == 0 || status == -SIGKILL) << status << part.errors();
      killed += status != 0;
      gone_on += kept;
      if (status != 0) continue;
      ++ended;
      expect_same(results(out), expected);
      fs::remove_all(out);
    }
    if (fs::exists(checkpoint("even")) || fs::exists(checkpoint("odd"))) expect_ends(expected), ++ended;
    EXPECT_GE(ended, 1);
    EXPECT_GE(gone_on, kills / 4);
    if (HasFailure()) return;
  }
}

// Files that cannot grow to the size of a checkpoint, as on a full disk. The run still ends, and reports each
// checkpoint that it could not write. A stopped run has to report that it cannot be resumed.
TEST_F(ResumedCommand, WithoutRoomForACheckpointContinuesWithoutIt) {
  write_scene(contracting);
  std::vector<std::string> settings;
  for (const char* one : {"fields=false", "frames=false", "maps=false", "tips_every=1", "probes_every=1"})
    settings.insert(settings.end(), {"--set", std::string("output.") + one});
  // 20 blocks of 512 bytes or 1 KiB, as the shell has it; a checkpoint takes more than 40 KiB.
  const auto with_small_files = [&](const std::string& more) {
    return Process(
        {"-c", fmt::format("trap '' XFSZ; ulimit -f 20; exec '{}' run '{}' --out '{}' --force "
                           "--quiet {} {}",
                           MYOWAVE_EXECUTABLE, scene.string(), out.string(), fmt::join(settings, " "), more)},
        told, "sh");
  };
  std::vector<std::string> line{"run", scene.string(), "--out", whole.string(), "--quiet"};
  line.insert(line.end(), settings.begin(), settings.end());
  ASSERT_EQ(run_myowave(line).status, 0);
  Process run = with_small_files("");
  EXPECT_EQ(run.wait(), 0) << run.errors();
  EXPECT_THAT(run.errors(), AllOf(HasSubstr("t = 0.6 t.u.: no checkpoint"), HasSubstr("File too large")));
  auto expected = results(whole), actual = results(out);
  EXPECT_THAT(actual.at("summary.json"), HasSubstr("no checkpoint"));  // among its warnings
  for (auto* one : {&expected, &actual}) one->erase("summary.json");
  std::erase_if(expected, [](const auto& file) { return file.first.starts_with("checkpoints"); });
  expect_same(actual, expected);

  fs::remove_all(out);
  Process stopped =
      with_small_files("--until 1e5 --set output.checkpoint_every=0 --set output.element_areas=false");
  ASSERT_TRUE(stopped.waits_until_there(out / "sources.csv", 20));
  stopped.send(SIGTERM);
  EXPECT_EQ(stopped.wait(), 1) << stopped.errors();
  EXPECT_THAT(stopped.errors(),
              AllOf(HasSubstr((out / "checkpoints").string()), HasSubstr("File too large")));
  EXPECT_EQ(run_myowave({"run", "--resume", out.string()}).status, 2);
}

TEST_F(ResumedCommand, DoesNotNeedItsSceneFile) {
  write_scene(contracting);
  const auto expected = undisturbed();
  stop_on_the_way();
  write_scene("[grid]\nn = 31\n");
  {
    Process rest = go_on();
    std::this_thread::sleep_for(milliseconds(60));
    rest.send(SIGTERM);
    rest.wait();
  }
  fs::remove(scene);
  expect_ends(expected);
}

TEST_F(ResumedCommand, UsesThePreviousOneIfTheNewestIsDamaged) {
  write_scene(contracting);
  const auto expected = undisturbed();
  stop_on_the_way();
  const bool even_is_newer = fs::last_write_time(checkpoint("even")) > fs::last_write_time(checkpoint("odd"));
  const fs::path newest = checkpoint(even_is_newer ? "even" : "odd");
  fs::resize_file(newest, fs::file_size(newest) - 1000);
  Process rest = go_on();
  EXPECT_EQ(rest.wait(), 0);
  EXPECT_THAT(rest.errors(), HasSubstr("not used: " + newest.string() + ": it is truncated"));
  expect_same(results(out), expected);
}

TEST_F(ResumedCommand, WithoutASoundCheckpointSaysWhatToDo) {
  write_scene(sheet);
  stop_on_the_way();
  for (const char* turn : {"even", "odd"}) fs::resize_file(checkpoint(turn), 100);
  const auto before = read_text(out / "tips.csv");
  const auto outcome = run_myowave({"run", "--resume", out.string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("no valid checkpoint to resume from"));
  EXPECT_THAT(outcome.errors, HasSubstr("--force"));
  EXPECT_EQ(read_text(out / "tips.csv"), before);
}

TEST_F(ResumedCommand, RefusesInvalidUse) {
  write_scene(sheet);
  stop_on_the_way();
  for (const auto& more : std::vector<std::vector<std::string>>{
           {scene.string()}, {"--set", "grid.n=31"}, {"--until", "9"}, {"--force"}}) {
    std::vector<std::string> line{"run", "--resume", out.string()};
    line.insert(line.end(), more.begin(), more.end());
    EXPECT_EQ(run_myowave(line).status, 2) << more.front();
  }
  EXPECT_EQ(run_myowave({"run", "--resume", (folder / "nowhere").string()}).status, 2);
  fs::remove(out / "tips.csv");
  const auto outcome = run_myowave({"run", "--resume", out.string()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr((out / "tips.csv").string()));
}

}  // namespace
}  // namespace myowave::test
