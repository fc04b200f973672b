#include "apps/results/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Kokkos_Core.hpp>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/base/progress_line.hpp"
#include "apps/input/initial_state.hpp"
#include "apps/results/summary_file.hpp"
#include "solver/base/error.hpp"
#include "solver/run/make_plan.hpp"
#include "tests/support/synthetic_frames.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

using test::read_text;
using test::SyntheticFrames;
using test::TemporaryFolder;
using testing::HasSubstr;
namespace fs = std::filesystem;

solver::Scene scene_of(int n, bool deforms, bool fields, bool frames) {
  solver::Scene scene;
  scene.output.probes = {{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  scene.grid.rows = scene.grid.columns = n;
  if (deforms) scene.mechanics.emplace();
  scene.output.fields = fields;
  scene.output.frames = frames;
  return scene;
}

std::string refusal(const fs::path& folder, bool force) {
  try {
    RunFolder(folder, scene_of(11, false, false, false), force, true);
  } catch (const solver::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RunFolder, HoldsAllFilesOfARun) {
  const TemporaryFolder folder;
  const auto scene = scene_of(21, true, true, true);
  {
    RunFolder run(folder / "a/b", scene, false, true);
    EXPECT_TRUE(run.wants_fields());
    run.write_manifest({{"grid", {{"n", 21}}}});
    SyntheticFrames frames(scene);
    for (const double t : {0.0, 0.1, 1.0 / 3}) {
      run.fields(frames.at(t));
      run.probes(t, std::vector<double>(12, t));
      const std::vector<solver::Tip> tips{{1.5, t, 1, 7}, {2, 3, -1}};
      run.tips(t, tips);
      run.area(t, 1, 0.9, 1.1);
    }
    run.tips(0.5, {});
    run.write_summary({}, std::nullopt);
  }
  EXPECT_EQ(read_text(folder / "a/b/probes.csv"),
            "t,V0,r0,Ta0,V1,r1,Ta1,V2,r2,Ta2,V3,r3,Ta3\n"
            "0,0,0,0,0,0,0,0,0,0,0,0,0\n"
            "0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1\n"
            "0.3333333333333333,0.3333333333333333,0.3333333333333333,0.3333333333333333,0.3333333333333333,"
            "0.3333333333333333,0.3333333333333333,0.3333333333333333,0.3333333333333333,0.3333333333333333,"
            "0.3333333333333333,0.3333333333333333,0.3333333333333333\n");
  EXPECT_THAT(read_text(folder / "a/b/tips.csv"),
              HasSubstr("t,x,y,charge,trajectory\n0,1.5,0,1,7\n0,2,3,-1,\n"));
  EXPECT_EQ(read_text(folder / "a/b/sources.csv"), "t,sources\n0,2\n0.1,2\n0.3333333333333333,2\n0.5,0\n");
  EXPECT_THAT(read_text(folder / "a/b/area.csv"), HasSubstr("t,area,area_min,area_max\n0,1,0.9,1.1\n"));
  EXPECT_THAT(read_text(folder / "a/b/fields.xdmf"), HasSubstr("</Xdmf>"));
  EXPECT_EQ(read_state(folder / "a/b/fields.h5", 21, 21, std::nullopt).V.size(), 441u);
  for (const char* frame : {"frame_00000.png", "frame_00001.png", "frame_00002.png"}) {
    EXPECT_TRUE(fs::exists(folder / "a/b/frames" / frame)) << frame;
  }
  // Nothing temporary is left.
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    EXPECT_NE(entry.path().extension(), ".tmp");
  }
}

TEST(RunFolder, RowsAreOnDiskAtOnce) {
  const TemporaryFolder folder;
  RunFolder run(folder / "out", scene_of(11, false, false, false), false, true);
  EXPECT_FALSE(run.wants_fields());
  run.probes(0.5, std::vector<double>{1, 2, 3});
  EXPECT_THAT(read_text(folder / "out/probes.csv"), testing::EndsWith("\n0.5,1,2,3\n"));
  EXPECT_FALSE(fs::exists(folder / "out/fields.h5"));
  EXPECT_FALSE(fs::exists(folder / "out/frames"));
}

TEST(RunFolder, ATrajectoryIsARow) {
  const TemporaryFolder folder;
  RunFolder run(folder / "out", scene_of(11, false, false, false), false, true);
  solver::TipTrajectory one{.number = 3,
                            .charge = -1,
                            .birth = 0.5,
                            .death = 40,
                            .born = solver::TipEvent::pair,
                            .ended = solver::TipEvent::run,
                            .core = solver::TipCore{10, 20, 1.5, 4},
                            .drift = solver::TipDrift{0.25, -1},
                            .boundary = 12};
  run.trajectory(one);
  run.trajectory({.number = 4,
                  .charge = 1,
                  .birth = 0,
                  .death = 1,
                  .born = solver::TipEvent::run,
                  .ended = solver::TipEvent::boundary,
                  .core = {},
                  .drift = {},
                  .boundary = {}});
  one.born = one.ended = solver::TipEvent::alone;
  one.drift.reset();
  run.trajectory(one);
  EXPECT_EQ(read_text(folder / "out/trajectories.csv"),
            "trajectory,charge,birth_tu,death_tu,born,ended,core_x,core_y,core_radius,drift_speed,"
            "drift_direction,boundary_tu\n"
            "3,-1,0.5,40,pair,end,10,20,1.5,0.25,-1,12\n"
            "4,1,0,1,start,boundary,,,,,,\n"
            "3,-1,0.5,40,alone,alone,10,20,1.5,,,12\n");
}

TEST(RunFolder, TensionThatIsNotComputedLeavesItsCellsEmpty) {
  const TemporaryFolder folder;
  auto scene = scene_of(11, false, true, false);
  scene.output.tension = false;
  {
    RunFolder run(folder / "out", scene, false, true);
    SyntheticFrames frames(scene);
    run.fields(frames.at(0.5));
    run.probes(0.5, std::vector<double>{1, 2, 0, 3, 4, 0});
  }
  EXPECT_THAT(read_text(folder / "out/probes.csv"), testing::EndsWith("\n0.5,1,2,,3,4,\n"));
  EXPECT_EQ(read_state(folder / "out/fields.h5", 11, 11, std::nullopt).Ta, std::vector<double>(121));
  EXPECT_THAT(read_text(folder / "out/fields.xdmf"), testing::Not(HasSubstr("Ta")));
}

TEST(RunFolder, UnknownValuesOfABeatAreEmpty) {
  const TemporaryFolder folder;
  RunFolder run(folder / "out", scene_of(11, false, false, false), false, true);
  run.beat({2, {.upstroke = 0.5, .period = 30, .apd = 21, .apd90 = 20.5, .di = 9.5}});
  run.beat({0, {.upstroke = 1.25}});
  EXPECT_EQ(read_text(folder / "out/beats.csv"),
            "probe,upstroke_tu,period_tu,apd_tu,apd90_tu,di_tu\n2,0.5,30,21,20.5,9.5\n0,1.25,,,,\n");
}

TEST(RunFolder, AreasOfElementsAreThereWhereTheSceneAsksForThem) {
  const TemporaryFolder folder;
  auto scene = scene_of(21, true, false, false);
  scene.output.element_areas = true;
  {
    RunFolder run(folder / "out", scene, false, true);
    run.element_areas(0.5, std::vector<double>{1, 0.25, 1.5, 1.25});
  }
  EXPECT_EQ(read_text(folder / "out/element_areas.csv"), "t,A0,A1,A2,A3\n0.5,1,0.25,1.5,1.25\n");
  scene.output.element_areas = false;
  const RunFolder without(folder / "out", scene, true, true);
  EXPECT_FALSE(fs::exists(folder / "out/element_areas.csv")) << "a result of the previous run";
}

TEST(RunFolder, RefusesAFolderWithResultsUnlessForced) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "out/frames");
  EXPECT_THAT(refusal(folder / "out", false), HasSubstr("--force"));
  for (const char* name :
       {"summary.json", "fields.h5", "notes.txt", "frames/frame_00007.png", "frames/mine.png"}) {
    std::ofstream(folder / (std::string("out/") + name)) << "old";
  }
  EXPECT_THAT(refusal(folder / "out", false), HasSubstr("out is there already"));
  EXPECT_EQ(read_text(folder / "out/summary.json"), "old");

  EXPECT_EQ(refusal(folder / "out", true), "");
  EXPECT_FALSE(fs::exists(folder / "out/summary.json"));
  EXPECT_FALSE(fs::exists(folder / "out/fields.h5"));
  EXPECT_FALSE(fs::exists(folder / "out/frames/frame_00007.png"));
  EXPECT_EQ(read_text(folder / "out/notes.txt"), "old") << "files of the user stay";
  EXPECT_EQ(read_text(folder / "out/frames/mine.png"), "old");
}

TEST(RunFolder, TakesAnEmptyFolder) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusal(folder.path(), false), "");
}

TEST(RunFolder, ReportsWhyAFolderCannotBeMade) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "text";
  EXPECT_THAT(refusal(folder / "file", false), HasSubstr("is a file"));
  EXPECT_THAT(refusal(folder / "file", true), HasSubstr("is a file"));
  EXPECT_THAT(refusal(folder / "file/out", false),
              testing::AllOf(HasSubstr("file/out"), HasSubstr("Not a directory")));
}

// No file may grow past a limit, as on a full disk.
TEST(RunFolder, AFailedWriteNamesTheFileAndLeavesWholeRows) {
  const TemporaryFolder folder;
  const auto child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4000, 4000};
    setrlimit(RLIMIT_FSIZE, &limit);
    RunFolder run(folder / "out", scene_of(11, false, false, false), false, true);
    try {
      for (int n = 0; n < 1000; ++n) run.area(n, 1, 0.5, 1.5);
    } catch (const std::runtime_error& error) {
      const std::string message = error.what();
      _exit(message.find("area.csv: File too large") != std::string::npos ? 0 : 2);
    }
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_THAT(read_text(folder / "out/area.csv"), HasSubstr("\n100,1,0.5,1.5\n"));
}

TEST(RunFolder, TheManifestSaysHowToRepeatTheRun) {
  const TemporaryFolder folder;
  RunFolder run(folder / "out", scene_of(11, false, false, false), false, true);
  run.write_manifest({{"time", {{"dt", 0.02}}}});
  const auto manifest = nlohmann::json::parse(read_text(folder / "out/manifest.json"));
  EXPECT_EQ(manifest["configuration"]["time"]["dt"], 0.02);
  EXPECT_FALSE(manifest["program"]["git_hash"].get<std::string>().empty());
  EXPECT_TRUE(manifest["program"]["git_dirty"].is_boolean());
  EXPECT_GE(manifest["backend"]["threads"].get<int>(), 1);
  EXPECT_GE(manifest["machine"]["cores"].get<int>(), 1);
  EXPECT_THAT(manifest["libraries"]["kokkos"].get<std::string>(),
              testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
}

TEST(Summary, HasTheKeysOfTheContract) {
  solver::RunSummary summary;
  summary.plan.parts = {{.part = "sheet", .active = true, .what = "flat", .why = "always", .device_bytes = 8},
                        {.part = "waves", .active = true, .what = "one", .why = "always"},
                        {.part = "mechanics", .why = "rigid"}};
  summary.steps = 100;
  summary.wall_s = 2;
  summary.memory = {{"Cuda", 9}, {"Host", 7}};
  summary.cell_steps_per_s = 5e8;
  summary.mechanics.solves = 3;
  summary.substepped_steps = 40;
  summary.largest_substeps = 2;
  summary.warnings = {"steps were divided into substeps"};
  summary.observables.period = {26.5, 0.25, 7};
  summary.observables.apd90 = {20.5, 0.5, 8};
  summary.observables.tips = {{1.5, 0.5, 100}, 7.5, 25, 0.1};
  summary.observables.tips_correlation_tu = 30;
  summary.observables.trajectories = {6, {1, 4, 0, 1}, {2, 4, 0, 0}};
  auto& longest = summary.observables.longest_trajectory.emplace();
  longest.number = 3;
  longest.core = {10, 20, 1.5, 4};
  longest.drift = {0.25, -1};
  summary.observables.breakup_tu = 42;
  summary.observables.area = {0.8, 1.1};
  summary.observables.shortening = {0.25, 33};
  const auto json = summary_json(summary, true, std::nullopt);
  EXPECT_EQ(json["model"], (nlohmann::ordered_json{"sheet: flat", "waves: one"}));
  EXPECT_EQ(json["plan"][0],
            (nlohmann::ordered_json{
                {"part", "sheet"}, {"active", true}, {"what", "flat"}, {"why", "always"}, {"bytes", 8}}));
  EXPECT_EQ(json["plan"][2]["why"], "rigid");
  EXPECT_EQ(json["steps"], 100);
  for (const char* phase : {"excitation", "transfer", "mechanics", "observe", "output"}) {
    EXPECT_TRUE(json["phases"][phase].is_number()) << phase;
  }
  EXPECT_EQ(json["wall_s"], 2);
  nlohmann::ordered_json planned{{Kokkos::DefaultExecutionSpace::memory_space::name(), 8}};
  if (solver::has_device_memory()) planned[Kokkos::HostSpace::name()] = 0;
  EXPECT_EQ(json["memory"]["planned_bytes"], planned);
  EXPECT_EQ(json["memory"]["most_bytes"], (nlohmann::ordered_json{{"Cuda", 9}, {"Host", 7}}));
  EXPECT_EQ(json["throughput"]["cell_steps_per_s"], 5e8);
  for (const char* key : {"solves", "left_out", "newton_iterations", "newton_max", "factorizations", "shifts",
                          "not_elliptic", "min_J"}) {
    EXPECT_TRUE(json["mechanics"][key].is_number()) << key;
  }
  EXPECT_EQ(json["observables"]["period"], (nlohmann::ordered_json{{"mean", 26.5}, {"sd", 0.25}, {"n", 7}}));
  EXPECT_EQ(json["observables"]["apd90"], (nlohmann::ordered_json{{"mean", 20.5}, {"sd", 0.5}, {"n", 8}}));
  EXPECT_EQ(json["observables"]["apd"],
            (nlohmann::ordered_json{{"mean", nullptr}, {"sd", nullptr}, {"n", 0}}));
  EXPECT_EQ(json["observables"]["tips"], (nlohmann::ordered_json{{"mean", 1.5},
                                                                 {"sd", 0.5},
                                                                 {"n", 100},
                                                                 {"correlation_tu", 30},
                                                                 {"effective_n", 25},
                                                                 {"standard_error", 0.1}}));
  EXPECT_EQ(json["observables"]["trajectories"]["n"], 6);
  EXPECT_EQ(json["observables"]["trajectories"]["born"],
            (nlohmann::ordered_json{{"start", 1}, {"pair", 4}, {"boundary", 0}, {"alone", 1}}));
  EXPECT_EQ(json["observables"]["trajectories"]["ended"],
            (nlohmann::ordered_json{{"end", 2}, {"pair", 4}, {"boundary", 0}, {"alone", 0}}));
  EXPECT_EQ(json["observables"]["core"], (nlohmann::ordered_json{{"trajectory", 3},
                                                                 {"x", 10},
                                                                 {"y", 20},
                                                                 {"radius", 1.5},
                                                                 {"rotations", 4},
                                                                 {"drift_speed", 0.25},
                                                                 {"drift_direction", -1},
                                                                 {"boundary_tu", nullptr}}));
  EXPECT_EQ(json["observables"]["breakup_tu"], 42);
  EXPECT_TRUE(json["observables"]["death_tu"].is_null());
  EXPECT_EQ(json["observables"]["area"], (nlohmann::ordered_json{{"min", 0.8}, {"max", 1.1}}));
  EXPECT_EQ(json["observables"]["shortening"], (nlohmann::ordered_json{{"max", 0.25}, {"t", 33}}));
  EXPECT_TRUE(json["failure"].is_null());
  EXPECT_EQ(json["warnings"], (nlohmann::ordered_json::array({"steps were divided into substeps"})));
  EXPECT_EQ(json["substeps"], (nlohmann::ordered_json{{"steps", 40}, {"largest", 2}}));
}

TEST(Summary, HasNullWhereThereIsNothing) {
  solver::RunSummary summary;
  summary.observables.period = {std::nan(""), std::nan(""), 0};
  summary.observables.tips = {{1, std::nan(""), 1}, {}};
  summary.cell_steps_per_s = std::numeric_limits<double>::infinity();
  const auto json = summary_json(summary, false, "V is nan at t = 3");
  EXPECT_TRUE(json["mechanics"].is_null());
  EXPECT_TRUE(json["throughput"]["cell_steps_per_s"].is_null());
  EXPECT_TRUE(json["observables"]["period"]["mean"].is_null());
  EXPECT_EQ(json["observables"]["period"]["n"], 0);
  EXPECT_EQ(json["observables"]["tips"]["mean"], 1);
  for (const char* key : {"sd", "correlation_tu", "effective_n", "standard_error"})
    EXPECT_TRUE(json["observables"]["tips"][key].is_null()) << key;
  EXPECT_EQ(json["observables"]["trajectories"]["n"], 0);
  EXPECT_TRUE(json["observables"]["core"].is_null());
  EXPECT_TRUE(json["observables"]["area"].is_null());
  EXPECT_TRUE(json["observables"]["shortening"].is_null());
  EXPECT_EQ(json["failure"], "V is nan at t = 3");
  EXPECT_THAT(json.dump(), testing::Not(HasSubstr("nan\"")));
}

TEST(Progress, ShowsTimeRateAndRemainingTime) {
  solver::Progress progress{100, 400, {}, 312.4e6, 1234, 2};
  EXPECT_EQ(progress_text(progress, 20, 10),
            " 25 %  t 100/400 t.u. (1000 ms)  ETA 1:00  312 Mcell-steps/s  Newton 1234  tips 2");
  progress.newton_iterations = 0;  // rigid
  EXPECT_EQ(progress_text(progress, 2000, 10),
            " 25 %  t 100/400 t.u. (1000 ms)  ETA 1:40:00  312 Mcell-steps/s  tips 2");
}

TEST(Progress, IsAPlainLineWithoutATerminal) {
  testing::internal::CaptureStderr();
  {
    ProgressLine line(10, false);
    for (int n = 0; n <= 100; ++n) line.show({double(n), 100, {}, 1e6, 0, 1});
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "run: 100 %  t 100/100 t.u. (1000 ms)  1 Mcell-steps/s  tips 1\n");
}

TEST(Progress, IsSilentWhenAsked) {
  testing::internal::CaptureStderr();
  ProgressLine(10, true).show({100, 100, {}, 1e6, 0, 1});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace myowave::apps
