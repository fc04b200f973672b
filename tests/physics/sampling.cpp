// Which samples a run gives, and when.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/allclose.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/reference_mechanics.hpp"

namespace myowave {
namespace {

using solver::Scene;
using testing_support::all_close;

// A front that ends in the middle of 3 x 4 elements.
Scene contracting_sheet() {
  Scene scene;
  scene.grid = {31, 41, 0.6};
  scene.time.t_end = 12;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.mechanics.emplace();
  scene.output.element_areas = true;
  return scene;
}

std::vector<double> times_of(const std::vector<test::RecordingSink::Area>& areas) {
  std::vector<double> times;
  for (const auto& area : areas) times.push_back(area.t);
  return times;
}

TEST(Sampling, ElementAreasAddUpToTheAreaOfTheSheet) {
  const test::RecordedRun run = test::recorded_run(contracting_sheet());
  ASSERT_EQ(run.sink.areas.size(), 13);
  ASSERT_EQ(run.sink.element_area_samples.size(), 13);
  double widest = 0;
  for (std::size_t n = 0; n < 13; ++n) {
    const auto& [t, ratios] = run.sink.element_area_samples[n];
    ASSERT_EQ(ratios.size(), 12);
    EXPECT_EQ(t, run.sink.areas[n].t);
    // at rest all elements are of one size
    EXPECT_NEAR(std::accumulate(ratios.begin(), ratios.end(), 0.0) / 12, run.sink.areas[n].total, 1e-8);
    const auto [smallest, largest] = std::ranges::minmax_element(ratios);
    EXPECT_EQ(*smallest, run.sink.areas[n].min);
    EXPECT_EQ(*largest, run.sink.areas[n].max);
    widest = std::max(widest, *largest - *smallest);
  }
  EXPECT_GT(widest, 0.1) << "a front contracts one part of the sheet before the other";
}

TEST(Sampling, ElementAreasAreThoseOfTheNodesShown) {
  const test::RecordedRun run = test::recorded_run(contracting_sheet());
  constexpr double rest_area = 1.2754145052;  // of the undeformed area under p = 10 kN/m
  std::vector<double> expected = reference::element_areas({3, 4, 6}, run.sink.nodes);
  for (double& area : expected) area /= 36 * rest_area;
  EXPECT_TRUE(all_close(run.sink.element_area_samples.back().ratios, expected, 4, {.absolute = 1e-8}));
}

TEST(Sampling, ElementAreasAreSampledOnRequest) {
  Scene scene = contracting_sheet();
  scene.time.t_end = 1;
  scene.output.element_areas = false;
  EXPECT_TRUE(test::recorded_run(scene).sink.element_area_samples.empty());
  scene.output.element_areas = true;
  scene.mechanics.reset();
  EXPECT_TRUE(test::recorded_run(scene).sink.element_area_samples.empty()) << "a rigid sheet has none";
}

TEST(Sampling, StartsAtTheFirstMultipleAndEndsWithTheRun) {
  Scene scene = contracting_sheet();
  scene.output.every = 0.6;
  scene.time.t_end = 2;
  scene.output.from = 1.2;  // 60 steps; 1.2 / 0.02 is a little less
  EXPECT_EQ(times_of(test::recorded_run(scene).sink.areas), (std::vector<double>{60 * 0.02, 90 * 0.02, 2}));
  scene.output.from = 1.21;
  EXPECT_EQ(times_of(test::recorded_run(scene).sink.areas), (std::vector<double>{90 * 0.02, 2}));
  scene.output.from = 1e300;
  const test::RecordedRun late = test::recorded_run(scene);
  EXPECT_EQ(times_of(late.sink.areas), (std::vector<double>{2}));
  EXPECT_FALSE(late.sink.V.empty()) << "the last state is written for runs that start from it";
  EXPECT_EQ(late.sink.tip_samples.size(), 3) << "tips are not shown every `every`";
}

// Paced as a whole, every node beats with the stimulus.
TEST(Sampling, BeatsOfAPacedSheetFollowTheStimulus) {
  Scene scene;
  scene.grid = {5, 7, 0.6};
  scene.time.t_end = 200;
  scene.stimuli = {{.period = 40, .duration = 1, .amplitude = 0.5, .count = -1}};
  scene.output.probes = {{0, 0}, {4, 3}};
  scene.output.period_from = 79;
  const test::RecordedRun run = test::recorded_run(scene);
  ASSERT_EQ(run.sink.beats.size(), 10);
  for (std::size_t n = 0; n < 10; ++n) {
    const auto& [probe, beat] = run.sink.beats[n];
    EXPECT_EQ(probe, n % 2);
    EXPECT_NEAR(beat.upstroke, 40 * static_cast<double>(n / 2) + 1, 0.5);
    EXPECT_GT(beat.apd, beat.apd90) << "it starts earlier";
    if (n < 8) {
      EXPECT_NEAR(beat.di + beat.apd90, beat.period, 1e-12);
    }
  }
  EXPECT_EQ(run.summary.observables.period.n, 4);
  EXPECT_NEAR(run.summary.observables.period.mean, 40, 0.01);
  EXPECT_EQ(run.summary.observables.apd90.n, 6) << "the last beats have ended and none follows";
}

// V = 1 on five columns of a cable of three rows.
test::RecordedRun plane_wave(solver::Precision precision) {
  Scene scene;
  scene.grid = {3, 201, 0.6};
  scene.time.t_end = 78;
  scene.precision = precision;
  scene.output.maps = true;
  scene.output.period_from = 0;
  for (int j = 20; j < 200; j += 7) scene.output.probes.push_back({1, j});
  solver::InitialState state = solver::make_initial_state(scene);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 6; ++j) state.V[i * 201 + j] = 1;
  return test::recorded_run(scene, state);
}

TEST(Sampling, MapOfAPlaneWaveHasItsVelocity) {
  for (const auto precision : {solver::Precision::float64, solver::Precision::float32}) {
    const test::RecordedRun run = plane_wave(precision);
    const auto& maps = run.sink.activation.value();
    EXPECT_NEAR(run.summary.observables.conduction_velocity->median, 1.535, 0.01 * 1.535);
    for (int j = 60; j < 180; ++j) EXPECT_NEAR(maps.conduction_velocity[201 + j], 1.535, 0.02 * 1.535) << j;
    EXPECT_EQ(maps.activation[201 + 100], maps.first_activation[201 + 100]);
    // Beats are found from every step, maps from each twentieth.
    double largest = 0;
    for (const auto& [probe, beat] : run.sink.beats)
      largest = std::max(largest, std::abs(maps.activation[201 + 20 + 7 * probe] - beat.upstroke));
    EXPECT_GT(run.sink.beats.size(), 20);
    EXPECT_LT(largest, 0.01);
  }
}

TEST(Sampling, MapOfAPacedSheetHasThePeriodOfTheStimulus) {
  Scene scene;
  scene.grid = {9, 35, 0.6};
  scene.time.t_end = 400;
  scene.stimuli = {{.period = 40, .duration = 1, .amplitude = 0.5, .count = -1}};
  scene.output.maps = true;
  scene.output.probes = {{4, 4}};
  const test::RecordedRun run = test::recorded_run(scene);
  const auto& maps = run.sink.activation.value();
  ASSERT_EQ(maps.period.size(), 9 * 35);
  for (std::size_t n = 0; n < maps.period.size(); ++n) {
    EXPECT_EQ(maps.beats[n], 10);
    EXPECT_NEAR(maps.period[n], 40, 0.01);
    EXPECT_NEAR(maps.period[n], run.summary.observables.period.mean, 0.01);
    EXPECT_NEAR(maps.period_sd[n], 0, 0.03) << "the beats settle, and samples are 0.4 apart";
    EXPECT_NEAR(maps.apd[n], run.summary.observables.apd90.mean, 0.02);
    EXPECT_TRUE(std::isnan(maps.conduction_velocity[n])) << "all at once is no front";
  }
  EXPECT_EQ(run.summary.observables.conduction_velocity->n, 0);
}

TEST(Sampling, MapsDoNotChangeTheRun) {
  Scene scene = contracting_sheet();
  const test::RecordedRun without = test::recorded_run(scene);
  scene.output.maps = true;
  const test::RecordedRun with = test::recorded_run(scene);
  EXPECT_FALSE(without.sink.activation);
  EXPECT_FALSE(without.summary.observables.conduction_velocity);
  ASSERT_TRUE(with.sink.activation);
  EXPECT_EQ(with.state.V, without.state.V);
  EXPECT_EQ(with.sink.nodes, without.sink.nodes);
}

}  // namespace
}  // namespace myowave
