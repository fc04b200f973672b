// Sweeps through the executable: each record equals that of the run alone, for any order, number of threads
// and shards.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/sweep/sweep_records.hpp"
#include "tests/support/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

// 31 x 31 nodes, rigid and contracting from the same preconditioned state; the last mu1 has no stable run.
constexpr const char* small_sweep = R"(
[stop]
on = ["breakup", "death"]
t_end = 12

[scene.grid]
n = 31
[scene.mechanics]
[scene.output]
period_from = 0
[scene.initial]
type = "broken_front"
precondition = { duration = 4, mu1 = 0.15 }

[[axis]]
key = "mechanics.on"
values = [false, true]

[[axis]]
key = "excitation.mu1"
values = [0.1, 0.12, 0.14]

[pair]
key = "mechanics.on"
)";

class Sweeps : public testing::Test {
 protected:
  Sweeps() { setenv("XDG_CACHE_HOME", MYOWAVE_TEST_CACHE, 1); }

  fs::path write(const std::string& text, const char* name = "small.toml") const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string path(const char* name) const { return (folder_ / name).string(); }

  Outcome sweep(const std::vector<std::string>& further) const {
    std::vector<std::string> arguments{"sweep", path("small.toml"), "--quiet"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return run_myowave(arguments);
  }

  json table(const std::string& name) const {
    const Outcome outcome = run_myowave({"sweep", "table", path(name.c_str()), "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return json::parse(outcome.output);
  }

  // Without times, places and speeds.
  json reproducible(const std::string& name) const {
    json rows = table(name)["rows"];
    for (json& row : rows)
      for (auto cell = row.begin(); cell != row.end();)
        cell = cell.key().starts_with("wall") || cell.key().starts_with("cell_steps") ? row.erase(cell)
                                                                                      : std::next(cell);
    return rows;
  }

  json record_of(const std::string& name, bool mechanics, double mu1) const {
    for (const auto& file : fs::directory_iterator(folder_ / (name + "/records"))) {
      std::istringstream lines(read_text(file.path()));
      for (std::string line; std::getline(lines, line);) {
        json record = json::parse(line);
        const json& given = record["configuration"];
        if (given["mechanics"]["on"] == mechanics && given["excitation"]["mu1"] == mu1) return record;
      }
    }
    return nullptr;
  }

  TemporaryFolder folder_;
};

TEST_F(Sweeps, RecordsAreThoseOfTheRunsAlone) {
  write(small_sweep);
  ASSERT_EQ(sweep({"--out", path("all"), "--jobs", "2"}).status, 0);
  std::ofstream(folder_ / "scene.toml")
      << "[grid]\nn = 31\n[mechanics]\n[output]\nperiod_from = 0\n[initial]\ntype = \"broken_front\"\n"
         "precondition = { duration = 4, mu1 = 0.15 }\n";
  for (const bool mechanics : {false, true})
    for (const double mu1 : {0.1, 0.12, 0.14}) {
      const Outcome alone = run_myowave(
          {"run", path("scene.toml"), "--quiet", "--force", "--out", path("alone"), "--until", "12", "--set",
           "time.stop_on=[\"breakup\",\"death\"]", "--set", "excitation.mu1=" + json(mu1).dump(), "--set",
           std::string("mechanics.on=") + (mechanics ? "true" : "false")});
      ASSERT_EQ(alone.status, 0) << alone.errors;
      const json summary = json::parse(read_text(folder_ / "alone/summary.json"));
      const json record = record_of("all", mechanics, mu1);
      ASSERT_TRUE(record.is_object());
      EXPECT_EQ(record["observables"].dump(), summary["observables"].dump());
      EXPECT_EQ(record["mechanics"].dump(), summary["mechanics"].dump());
      EXPECT_EQ(record["warnings"].dump(), summary["warnings"].dump());
      EXPECT_EQ(record["steps"], summary["steps"]);
    }
  // One state for all six.
  const auto states = fs::directory_iterator(folder_ / "all/states");
  EXPECT_EQ(std::count_if(begin(states), end(states),
                          [](const auto& entry) { return entry.path().extension() == ".h5"; }),
            1);
}

TEST_F(Sweeps, AreTheSameInAnyPartsAndOrder) {
  write(small_sweep);
  ASSERT_EQ(sweep({"--out", path("whole"), "--jobs", "1"}).status, 0);
  EXPECT_EQ(table("whole")["rows"].size(), 6u);
  for (const char* shard : {"3/3", "1/3"})
    ASSERT_EQ(sweep({"--out", path("parts"), "--shard", shard, "--jobs", "2"}).status, 0);
  EXPECT_EQ(table("parts")["rows"].size(), 4u);
  EXPECT_EQ(table("parts")["missing"], 2);
  ASSERT_EQ(sweep({"--out", path("parts"), "--shard", "2/3"}).status, 0);
  EXPECT_EQ(reproducible("parts").dump(), reproducible("whole").dump());
  EXPECT_TRUE(fs::exists(folder_ / "parts/records/shard_2_of_3.jsonl"));
}

TEST_F(Sweeps, RunOnlyWhatIsMissing) {
  write(small_sweep);
  ASSERT_EQ(sweep({"--out", path("a")}).status, 0);
  const std::string records = read_text(folder_ / "a/records/shard_1_of_1.jsonl");
  ASSERT_EQ(sweep({"--out", path("a")}).status, 0);
  EXPECT_EQ(read_text(folder_ / "a/records/shard_1_of_1.jsonl"), records);
  // One value more is two runs more; the table has the new plan's.
  std::string more = small_sweep;
  more.replace(more.find("0.14"), 4, "0.13");
  write(more);
  const Outcome outcome = sweep({"--out", path("a")});
  EXPECT_THAT(outcome.output, HasSubstr("6 runs done, 0 of them failed"));
  const std::string longer = read_text(folder_ / "a/records/shard_1_of_1.jsonl");
  EXPECT_TRUE(longer.starts_with(records));
  EXPECT_EQ(std::ranges::count(longer, '\n'), 8);
  EXPECT_EQ(table("a")["rows"][2]["excitation.mu1"], 0.13);
}

TEST_F(Sweeps, FailedRunsAreRecordedAndOthersContinue) {
  // So strong a stimulus leaves no finite V.
  write(R"(
[stop]
t_end = 5
[scene.grid]
n = 21
[[scene.stimulus]]
amplitude = 0.5
[[axis]]
key = "stimulus.0.amplitude"
values = [0.5, 200, 1]
)");
  const Outcome outcome = sweep({"--out", path("f")});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("3 runs done, 1 of them failed"));
  const json rows = table("f")["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1]["outcome"], "failed");
  EXPECT_THAT(rows[1]["failure"].get<std::string>(), HasSubstr("t = "));
  EXPECT_EQ(rows[2]["outcome"], "end");
  const auto lines = [&] {
    return std::ranges::count(read_text(folder_ / "f/records/shard_1_of_1.jsonl"), '\n');
  };
  ASSERT_EQ(sweep({"--out", path("f")}).status, 0);
  EXPECT_EQ(lines(), 3);
  ASSERT_EQ(sweep({"--out", path("f"), "--retry-failed"}).status, 0);
  EXPECT_EQ(lines(), 4);
}

TEST_F(Sweeps, ADryRunWritesNothing) {
  write(small_sweep);
  const Outcome outcome = sweep({"--out", path("dry"), "--dry-run", "--jobs", "2"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("small: 6 runs\n"));
  EXPECT_THAT(outcome.output, HasSubstr("shared states           1, from which 6 runs start\n"));
  EXPECT_THAT(outcome.output, HasSubstr("with 2 in parallel"));
  EXPECT_FALSE(fs::exists(folder_ / "dry"));
}

TEST_F(Sweeps, ReportWhatIsWrong) {
  write(small_sweep);
  EXPECT_EQ(sweep({"--shard", "0/3"}).status, 2);
  EXPECT_THAT(sweep({"--shard", "4/3"}).errors, HasSubstr("--shard must be I/N with I from 1 to N"));
  EXPECT_EQ(run_myowave({"sweep"}).status, 2);
  EXPECT_EQ(run_myowave({"sweep", "table", path("nothing")}).status, 2);
  fs::create_directories(folder_ / "other");
  std::ofstream(folder_ / "other/file") << "x";
  EXPECT_THAT(sweep({"--out", path("other")}).errors, HasSubstr("holds something else than a sweep"));
  EXPECT_FALSE(fs::exists(folder_ / "other/records"));
}

TEST_F(Sweeps, TablesHaveAColumnForEachAxis) {
  write(small_sweep);
  ASSERT_EQ(sweep({"--out", path("t")}).status, 0);
  const std::string csv = run_myowave({"sweep", "table", path("t"), "--csv"}).output;
  EXPECT_TRUE(csv.starts_with("mechanics.on,excitation.mu1,outcome,breakup_tu,death_tu,")) << csv;
  EXPECT_THAT(csv, HasSubstr(",period_mean_tu,"));
  EXPECT_THAT(csv, HasSubstr(",tips_mean,"));
  EXPECT_THAT(csv, HasSubstr(",wall_s,"));
  EXPECT_THAT(csv, HasSubstr("\nfalse,0.1,"));
  EXPECT_THAT(run_myowave({"sweep", "status", path("t")}).output,
              HasSubstr("small: 6 runs, 6 done, 0 to do"));
  const Outcome report = run_myowave({"report", path("t")});
  EXPECT_EQ(report.status, 0) << report.errors;
  EXPECT_THAT(read_text(folder_ / "t/report.html"), HasSubstr("Pairs from the same state"));
  EXPECT_TRUE(fs::exists(folder_ / "t/plots/breakup.svg"));
}

TEST_F(Sweeps, SlurmScript) {
  write(small_sweep);
  const Outcome outcome = sweep({"--out", path("s"), "--slurm", "--tasks", "3", "--time", "1:00:00"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("sbatch " + path("s/sweep.sbatch")));
  EXPECT_THAT(outcome.output, HasSubstr("parallel --joblog"));
  EXPECT_THAT(read_text(folder_ / "s/sweep.sbatch"), HasSubstr("#SBATCH --array=1-3\n"));
  if (std::system("command -v shellcheck >/dev/null") == 0) {
    EXPECT_EQ(std::system(("shellcheck " + path("s/sweep.sbatch")).c_str()), 0);
  }
  EXPECT_EQ(sweep({"--slurm", "--time", "soon"}).status, 2);
  EXPECT_EQ(sweep({"--tasks", "3"}).status, 2);
}

TEST_F(Sweeps, TheLineForGnuParallelDoesAllShards) {
  if (std::system("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "GNU parallel is not installed";
  write(small_sweep);
  ASSERT_EQ(sweep({"--out", path("whole")}).status, 0);
  const Outcome outcome = sweep({"--out", path("p"), "--slurm", "--tasks", "3", "--cpus", "1"});
  const auto begin = outcome.output.find("seq 3 |");
  ASSERT_NE(begin, std::string::npos) << outcome.output;
  const std::string line = outcome.output.substr(begin) + " 2>" + path("told.txt");
  const auto in_shell = [](std::string text) {
    std::erase(text, '\n');
    return std::system(text.c_str());
  };
  EXPECT_EQ(in_shell(line), 0) << read_text(folder_ / "told.txt");
  EXPECT_EQ(reproducible("p"), reproducible("whole"));
  const std::string log = read_text(folder_ / "p/parallel.log");
  EXPECT_EQ(std::ranges::count(log, '\n'), 4) << log;
  // All runs are done.
  EXPECT_EQ(in_shell(line), 0);
  EXPECT_EQ(read_text(folder_ / "p/parallel.log"), log);
}

// Records as another revision would have left them.
TEST_F(Sweeps, RepeatsRunsOfOtherRevisionsOnRequest) {
  write(small_sweep);
  ASSERT_EQ(sweep({"--out", path("a")}).status, 0);
  const json expected = reproducible("a");
  const fs::path file = folder_ / "a/records/shard_1_of_1.jsonl";
  std::istringstream lines(read_text(file));
  std::string others;
  for (std::string line; std::getline(lines, line);) {
    auto record = nlohmann::ordered_json::parse(line);
    record.erase("check");
    record["program"]["git_hash"] = "another";
    record["outcome"] = "failed";
    others += apps::record_line(record);
  }
  std::ofstream(file) << others;
  const Outcome kept = sweep({"--out", path("a")});
  EXPECT_EQ(kept.status, 0);
  EXPECT_THAT(kept.errors, HasSubstr("6 of the finished runs are of another revision of myowave"));
  EXPECT_EQ(read_text(file), others);
  ASSERT_EQ(sweep({"--out", path("a"), "--redo-other-revisions"}).status, 0);
  EXPECT_TRUE(read_text(file).starts_with(others));
  EXPECT_EQ(reproducible("a"), expected);
}

// Fig 11's rigid spiral at mu1 = 0.1 (apps/paper/first_breakup.cpp): its initial state from a separate run.
TEST_F(Sweeps, BreakUpIsThatOfTheFigure) {
  write("scene = \"" MYOWAVE_SOURCE_DIR
        "/apps/scenes/rigid_spiral.toml\"\n"
        R"(
[stop]
on = ["breakup", "death"]
t_end = 400
[[axis]]
key = "excitation.mu1"
values = [0.1]
[[axis]]
key = "output.tips_every"
values = [1]
)");
  ASSERT_EQ(sweep({"--out", path("b")}).status, 0);
  const std::string scene = MYOWAVE_SOURCE_DIR "/apps/scenes/rigid_spiral.toml";
  const auto run = [&](std::vector<std::string> settings, const char* out) {
    std::vector<std::string> arguments{"run", scene, "--quiet", "--out", path(out)};
    for (auto& one : settings) arguments.insert(arguments.end(), {"--set", std::move(one)});
    const Outcome outcome = run_myowave(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
  };
  run({"initial={type = \"broken_front\", width = 5, r0 = 1.5, offset = [-5, 40]}", "excitation.mu1=0.15",
       "time.t_end=270", "output.every=270", "output.frames=false"},
      "state");
  run({"initial={type = \"file\", file = \"" + path("state/fields.h5") + "\"}", "excitation.mu1=0.1",
       "time.stop_on=[\"breakup\", \"death\"]", "output.tips_every=1", "output.frames=false",
       "output.fields=false"},
      "run");
  const json alone = json::parse(read_text(folder_ / "run/summary.json"))["observables"];
  ASSERT_TRUE(alone["breakup_tu"].is_number());
  const json row = table("b")["rows"][0];
  EXPECT_EQ(row["outcome"], "breakup");
  EXPECT_EQ(row["breakup_tu"], alone["breakup_tu"]);
}

}  // namespace
}  // namespace myowave::test
