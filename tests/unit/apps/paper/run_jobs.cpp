// Runs in separate processes: their files, their order, and the effect of a failure on the others.
#include "apps/paper/run_jobs.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "apps/base/revision.hpp"
#include "apps/input/scene_file.hpp"
#include "apps/results/run_results.hpp"
#include "solver/base/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// A sheet of 11 x 11 nodes, a front in it, one time unit.
SceneText small_scene() {
  return SceneText(R"(
[grid]
n = 11
[time]
t_end = 1
[initial]
type = "broken_front"
[output]
fields = true
)");
}

struct Told {
  std::vector<std::string> names;
  std::map<std::string, JobOutcome> outcomes;
};

Told run(const std::vector<Job>& jobs, const fs::path& folder, int parallel = 2) {
  Told told;
  told.outcomes =
      run_jobs(MYOWAVE_EXECUTABLE, jobs, folder, parallel,
               [&](const std::string& name, const JobOutcome&, std::size_t) { told.names.push_back(name); });
  return told;
}

TEST(SceneText, SetsWhatIsNamedAndKeepsTheRest) {
  SceneText text("[grid]\nn = 31\n[[stimulus]]\namplitude = 1\n[[stimulus]]\namplitude = 2\n");
  text.set("grid.dx", "0.3").set("stimulus.1.region", "{columns = [7, 8]}").set("time.t_end", "4.5");
  const solver::Scene scene = parse_scene(text.text(), "scene.toml");
  EXPECT_EQ(scene.grid.columns, 31);
  EXPECT_EQ(scene.grid.dx, 0.3);
  EXPECT_EQ(scene.time.t_end, 4.5);
  EXPECT_EQ(scene.stimuli[0].amplitude, 1);
  EXPECT_EQ(scene.stimuli[0].shape, solver::Stimulus::Shape::all);
  EXPECT_EQ(scene.stimuli[1].amplitude, 2);
  EXPECT_EQ(scene.stimuli[1].columns[1], 8);
}

// A run that starts from the last state of another equals one run over both times.
TEST(RunJobs, StateOfOneRunStartsAnother) {
  const test::TemporaryFolder folder;
  const std::string whole = small_scene().set("time.t_end", "2.0").text();
  const std::string second =
      small_scene().set("initial", "{type = \"file\", file = \"../runs/first/fields.h5\"}").text();
  const Told told =
      run({{"second", second, {"first"}}, {"first", small_scene().text(), {}}, {"whole", whole, {}}},
          folder.path());
  for (const auto& [name, outcome] : told.outcomes) EXPECT_TRUE(outcome.ok()) << name << outcome.message;
  EXPECT_EQ(RunResults(folder / "runs/second").last_frame().V,
            RunResults(folder / "runs/whole").last_frame().V);
}

TEST(RunJobs, FailureEndsOnlyThoseThatNeedIt) {
  const test::TemporaryFolder folder;
  const std::string unstable = small_scene().set("time.dt", "0.5").text();
  const Told told = run({{"bad", unstable, {}},
                         {"needs_bad", small_scene().text(), {"bad"}},
                         {"good", small_scene().text(), {}}},
                        folder.path());
  EXPECT_EQ(told.outcomes.at("bad").status, 2);
  EXPECT_THAT(told.outcomes.at("bad").message, HasSubstr("time.dt = 0.5"));
  EXPECT_EQ(told.outcomes.at("needs_bad").status, -1);
  EXPECT_THAT(told.outcomes.at("needs_bad").message, HasSubstr("bad"));
  EXPECT_FALSE(fs::exists(folder / "runs/needs_bad"));
  EXPECT_TRUE(told.outcomes.at("good").ok());
  EXPECT_EQ(told.names.size(), 3u);
}

TEST(RunJobs, FinishedRunsAreReusedUntilTheirSceneChanges) {
  if (has_local_changes()) GTEST_SKIP() << "a program with uncommitted changes repeats every run";
  const test::TemporaryFolder folder;
  const std::string from_first =
      small_scene().set("initial", "{type = \"file\", file = \"../runs/first/fields.h5\"}").text();
  const std::string first = small_scene().text(), longer = small_scene().set("time.t_end", "2.0").text();
  run({{"first", first, {}}, {"second", from_first, {"first"}}}, folder.path());
  const Told again = run({{"first", first, {}}, {"second", from_first, {"first"}}}, folder.path());
  EXPECT_TRUE(again.outcomes.at("first").reused);
  EXPECT_TRUE(again.outcomes.at("second").reused);
  const Told changed = run({{"first", longer, {}}, {"second", from_first, {"first"}}}, folder.path());
  EXPECT_FALSE(changed.outcomes.at("first").reused);
  EXPECT_FALSE(changed.outcomes.at("second").reused);
}

TEST(RunJobs, TheNumberOfParallelRunsChangesNoResult) {
  const test::TemporaryFolder one, three;
  std::vector<Job> jobs;
  for (const char* mu1 : {"0.07", "0.1", "0.12"})
    jobs.push_back({mu1, small_scene().set("excitation.mu1", mu1).text(), {}});
  run(jobs, one.path(), 1);
  run(jobs, three.path(), 3);
  for (const Job& job : jobs)
    EXPECT_EQ(RunResults(one.path() / "runs" / job.name).last_frame().V,
              RunResults(three.path() / "runs" / job.name).last_frame().V);
}

TEST(RunJobs, ThreadsAreSharedInTheEnvironmentOfTheRunsAlone) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "environment.sh") << "#!/bin/sh\nenv\n";
  fs::permissions(folder / "environment.sh", fs::perms::owner_all);
  setenv("OMP_NUM_THREADS", "777", 1);
  setenv("MYOWAVE_TEST_VARIABLE", "as it is", 1);
  const std::vector<Job> jobs{{"one", small_scene().text(), {}}};
  run_jobs(folder / "environment.sh", jobs, folder.path(), 100000,
           [](const std::string&, const JobOutcome& outcome, std::size_t) { EXPECT_TRUE(outcome.ok()); });
  EXPECT_STREQ(std::getenv("OMP_NUM_THREADS"), "777");
  unsetenv("OMP_NUM_THREADS");
  unsetenv("MYOWAVE_TEST_VARIABLE");
  std::ifstream log(folder / "runs/one.log");
  const std::string environment{std::istreambuf_iterator<char>(log), {}};
  EXPECT_THAT(environment, HasSubstr("OMP_NUM_THREADS=1\n"));
  EXPECT_THAT(environment, HasSubstr("OMP_PROC_BIND=false\n"));
  EXPECT_THAT(environment, HasSubstr("MYOWAVE_TEST_VARIABLE=as it is\n"));
  EXPECT_THAT(environment, testing::Not(HasSubstr("777")));
}

TEST(RunJobs, RefusesWhatCannotBegin) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(run({{"a", small_scene().text(), {"b"}}}, folder.path()), solver::InputError);
  EXPECT_THROW(run({{"a", small_scene().text(), {"b"}}, {"b", small_scene().text(), {"a"}}}, folder.path()),
               solver::InputError);
}

}  // namespace
}  // namespace myowave::apps
