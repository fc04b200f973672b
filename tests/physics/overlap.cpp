// mechanics.overlap: conduction feels the deformation of one interval before, and the thread that
// solves meanwhile changes no bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "solver/error.hpp"
#include "solver/run.hpp"
#include "tests/support/plain_sheet.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using test::PlainSheet;
using ::testing::HasSubstr;

constexpr int interval = 40;

solver::Scene overlapping(int steps) {
  solver::Scene scene;
  scene.grid = {81, 61, 0.6};
  scene.time.t_end = steps * scene.time.dt;
  scene.mechanics.emplace();
  scene.mechanics->interval = interval;
  scene.mechanics->overlap = true;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.every = interval * scene.time.dt;
  return scene;
}

class OverlapOf : public ::testing::TestWithParam<solver::MetricTime> {};

TEST_P(OverlapOf, IsTheMetricOfOneIntervalBeforeToTheBit) {
  constexpr int steps = 6 * interval + interval / 2;
  solver::Scene scene = overlapping(steps);
  scene.metric_time = GetParam();
  scene.time.dt = 1.0 / 64;  // sums of its multiples are exact in whatever order
  scene.time.t_end = steps * scene.time.dt;
  scene.output.every = scene.time.t_end;
  const test::RecordedRun result = test::recorded_run(scene);
  const PlainSheet plain(scene, solver::make_initial_state(scene));
  EXPECT_EQ(result.state.V, test::to_values(plain.V));
  EXPECT_EQ(result.state.r, test::to_values(plain.r));
  EXPECT_EQ(result.state.Ta, test::to_values(plain.Ta));
  // What is shown is the sheet as it was solved, wherever conduction feels it.
  EXPECT_EQ(result.sink.nodes, plain.nodes);

  solver::Scene held = scene;
  held.mechanics->overlap = false;
  EXPECT_NE(test::recorded_run(held).state.V, result.state.V);
}

std::string time_name(const ::testing::TestParamInfo<solver::MetricTime>& info) {
  constexpr std::array names{"held", "linear", "quadratic"};
  return names[static_cast<std::size_t>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(Times, OverlapOf,
                         ::testing::Values(solver::MetricTime::held, solver::MetricTime::linear,
                                           solver::MetricTime::quadratic),
                         time_name);

TEST(Overlap, TheSameRunTwiceIsTheSameToTheBit) {
  const solver::Scene scene = overlapping(5 * interval);
  const test::RecordedRun one = test::recorded_run(scene), two = test::recorded_run(scene);
  EXPECT_EQ(one.state.V, two.state.V);
  EXPECT_EQ(one.sink.nodes, two.sink.nodes);
  EXPECT_EQ(one.summary.mechanics.newton_iterations, two.summary.mechanics.newton_iterations);
}

// Or left out: the first finds the rest state's tension.
TEST(Overlap, EverySolveThatIsDueIsDone) {
  for (const int steps : {0, 1, interval, 3 * interval, 3 * interval + 1}) {
    solver::Scene scene = overlapping(steps);
    const test::RecordedRun overlapped = test::recorded_run(scene);
    scene.mechanics->overlap = false;
    const test::RecordedRun held = test::recorded_run(scene);
    for (const auto& mechanics : {overlapped.summary.mechanics, held.summary.mechanics}) {
      EXPECT_EQ(mechanics.solves, steps / interval) << steps;
      EXPECT_EQ(mechanics.left_out, 1) << steps;
    }
  }
}

// The area of each sample is that of a held run of the same interval, one interval later. The two
// runs differ through the feedback, which is off here.
TEST(Overlap, AreasComeOneIntervalLater) {
  solver::Scene scene = overlapping(5 * interval);
  scene.metric = solver::MetricForm::none;
  const test::RecordedRun overlapped = test::recorded_run(scene);
  scene.mechanics->overlap = false;
  const test::RecordedRun held = test::recorded_run(scene);
  ASSERT_EQ(overlapped.sink.areas.size(), 6U);
  EXPECT_EQ(overlapped.sink.areas[0].total, held.sink.areas[0].total);
  for (std::size_t n = 1; n < 6; ++n) {
    EXPECT_EQ(overlapped.sink.areas[n].total, held.sink.areas[n - 1].total);
    EXPECT_NE(held.sink.areas[n].total, held.sink.areas[n - 1].total);
  }
  // No solve is lost to the summary.
  EXPECT_EQ(overlapped.summary.observables.area, held.summary.observables.area);
  EXPECT_EQ(overlapped.summary.observables.shortening, held.summary.observables.shortening);
}

// No equilibrium at the first solve that sees tension, step 40.
TEST(Overlap, AFailureNamesTheTimeOfItsTensionAndSurfacesAtTheNextSolveOrTheEnd) {
  for (const auto& [steps, reached] : {std::pair{10 * interval, 2 * interval}, std::pair{60, 60}}) {
    solver::Scene scene = overlapping(steps);
    scene.grid = {41, 41, 0.6};
    scene.tension.k_Ta = 1e5;
    test::RecordingSink sink;
    solver::RunSummary summary;
    try {
      solver::run(scene, solver::make_initial_state(scene), sink, summary);
      ADD_FAILURE() << "no failure";
    } catch (const solver::NumericalFailure& failure) {
      EXPECT_THAT(failure.what(), HasSubstr("mechanics at t = 0.8 t.u.: no equilibrium found"));
    }
    EXPECT_EQ(summary.steps, reached);
  }
}

// The steps fail while the solve begun before them is at work, and it ends first.
TEST(Overlap, AFailureOfTheStepsWaitsForTheSolve) {
  solver::Scene scene = overlapping(10 * interval);
  scene.stimuli.push_back({.start = 1.7, .duration = 1, .amplitude = 200});
  EXPECT_THROW(test::recorded_run(scene), solver::NumericalFailure);
}

}  // namespace
}  // namespace myowave
