// Runs that end at the sample that finds break-up or death.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/breakup.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave::solver {
namespace {

using test::recorded_run;

// A wave that starts at one edge and leaves at the other.
Scene one_wave() {
  Scene scene;
  scene.grid = {11, 61, 0.6};
  scene.time.t_end = 200;
  Stimulus stimulus;
  stimulus.amplitude = 2;
  stimulus.shape = Stimulus::Shape::block;
  stimulus.columns = {0, 3};
  stimulus.rows = {0, 10};
  scene.stimuli = {stimulus};
  scene.output.every = 3;
  scene.output.tips_every = 7;
  scene.output.probes_every = 11;
  scene.output.probes = {{5, 30}};
  return scene;
}

TEST(StopOn, DeathEndsTheRunAtTheSampleThatFindsIt) {
  Scene scene = one_wave();
  const auto whole = recorded_run(scene);
  ASSERT_TRUE(whole.summary.observables.death_tu);
  const double death = *whole.summary.observables.death_tu;
  EXPECT_GT(death, 50);
  EXPECT_LT(death, 150);
  scene.time.stop_on.death = true;
  const auto run = recorded_run(scene);
  EXPECT_EQ(*run.summary.observables.death_tu, death);
  EXPECT_EQ(run.summary.t, death);
  EXPECT_EQ(run.summary.steps, std::llround(death / scene.time.dt));
  // Everything is sampled there, as at t_end, and nothing later.
  EXPECT_EQ(run.sink.probe_samples.back().t, death);
  EXPECT_EQ(run.sink.tip_samples.back().t, death);
  EXPECT_EQ(run.sink.last_frame_t, death);
  EXPECT_EQ(run.sink.V, run.state.V);
  // Until then it equals the other run.
  for (std::size_t n = 0; n + 1 < run.sink.probe_samples.size(); ++n)
    EXPECT_EQ(run.sink.probe_samples[n].values, whole.sink.probe_samples[n].values);
}

TEST(StopOn, AStateAsLongAsTheShortenedRunIsTheSame) {
  Scene scene = one_wave();
  scene.mechanics.emplace();
  scene.mechanics->cells_per_element = 5;
  scene.time.stop_on.death = true;
  const auto stopped = recorded_run(scene);
  ASSERT_LT(stopped.summary.t, 200);
  scene.time.stop_on = {};
  scene.time.t_end = stopped.summary.t;
  const auto run = recorded_run(scene);
  EXPECT_EQ(run.state.V, stopped.state.V);
  EXPECT_EQ(run.state.Ta, stopped.state.Ta);
  EXPECT_EQ(run.sink.nodes, stopped.sink.nodes);
  EXPECT_EQ(run.sink.areas.size(), stopped.sink.areas.size());
  EXPECT_EQ(run.sink.areas.back().t, stopped.sink.areas.back().t);
}

// A sheet with a future stimulus is not dead.
TEST(StopOn, AFutureStimulusIsAwaited) {
  Scene scene = one_wave();
  scene.time.stop_on = {true, true};
  scene.time.t_end = 260;
  scene.stimuli.push_back(scene.stimuli[0]);
  scene.stimuli[1].start = 250;
  EXPECT_EQ(recorded_run(scene).summary.t, 260);
}

// At mu1 = 0.07 a broken front becomes turbulent in a rigid sheet.
TEST(StopOn, BreakupEndsTheRunOnceItHasLasted) {
  Scene scene;
  scene.grid = {121, 121, 0.6};
  scene.excitation.mu1 = 0.07;
  scene.time.t_end = 600;
  scene.initial.type = InitialSettings::Type::broken_front;
  scene.initial.width = 10;
  scene.output.every = 50;
  scene.time.stop_on = {true, true};
  const auto run = recorded_run(scene);
  ASSERT_TRUE(run.summary.observables.breakup_tu);
  EXPECT_FALSE(run.summary.observables.death_tu);
  EXPECT_NEAR(run.summary.t, *run.summary.observables.breakup_tu + BreakupWatch::must_last, 1e-9);
  EXPECT_EQ(run.sink.last_frame_t, run.summary.t);
}

TEST(StopOn, WithoutAnEventTheRunReachesItsEnd) {
  Scene scene = one_wave();
  scene.time.stop_on = {true, true};
  scene.time.t_end = 20;
  EXPECT_EQ(recorded_run(scene).summary.t, 20);
  scene.time.t_end = 0;
  EXPECT_EQ(recorded_run(scene).sink.tip_samples.size(), 1U);
}

}  // namespace
}  // namespace myowave::solver
