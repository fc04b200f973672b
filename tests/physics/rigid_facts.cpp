// Numbers of the rigid medium at the paper's settings, found by independent programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/cell/aliev_panfilov.hpp"
#include "solver/analysis/cell_protocol.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using test::RecordingSink;
using test::Trace;

// A cable of length 120 as a sheet of two equal rows, V = 1 on x <= 3.
struct Cable {
  double conduction_velocity, apd, largest_rate;
  std::vector<solver::ProbeBeat> beats;
  solver::MeanSd apd_of_beats;
};

Cable run_cable(double dx, double dt, solver::Scheme scheme = solver::Scheme::euler) {
  const int n = static_cast<int>(std::lround(120 / dx)) + 1;
  solver::Scene scene;
  scene.grid = {2, n, dx};
  scene.time = {dt, 140, 10};
  scene.scheme = scheme;
  scene.output.probes_every = dt;
  scene.output.period_from = 0;
  scene.output.probes = {{0, n / 3}, {0, 2 * n / 3}, {0, n / 2}};
  solver::InitialState state = solver::make_initial_state(scene);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < n; ++j)
      if (j * dx <= 3 + 1e-9) state.V[static_cast<std::size_t>(i) * n + j] = 1;
  RecordingSink sink;
  solver::RunSummary summary;
  solver::run(scene, state, sink, summary);

  const double near = V_trace(sink, 0).crossing(0.5, true), far = V_trace(sink, 1).crossing(0.5, true);
  const Trace middle = V_trace(sink, 2);
  const double up = middle.crossing(0.1, true), down = middle.crossing(0.1, false);
  double largest_rate = 0;
  for (std::size_t k = 1; k < middle.t.size(); ++k)
    largest_rate = std::max(largest_rate, (middle.value[k] - middle.value[k - 1]) / dt);
  return {(2 * n / 3 - n / 3) * dx / (far - near), down - up, largest_rate, sink.beats,
          summary.observables.apd};
}

TEST(RigidFacts, PlaneWaveAtThePapersResolution) {
  const Cable cable = run_cable(0.6, 0.02);
  EXPECT_NEAR(cable.conduction_velocity, 1.5350, 0.00005);
  EXPECT_NEAR(cable.apd, 36.71, 0.005);
  EXPECT_NEAR(cable.largest_rate, 0.810, 0.0005);
  ASSERT_EQ(cable.beats.size(), 3) << "one at each probe";
  for (const auto& [probe, beat] : cable.beats) EXPECT_NEAR(beat.apd, 36.71, 0.02) << probe;
  EXPECT_EQ(cable.apd_of_beats.n, 3);
  EXPECT_NEAR(cable.apd_of_beats.mean, 36.71, 0.01);
}

// At dt = dx^2 / (6 D) the errors of diffusion and stencil are gone. Velocities of a plain loop over this
// cable; its limit of small steps is 1.589.
TEST(RigidFacts, PlaneWaveInSplitSteps) {
  const auto split = [](double dx) { return run_cable(dx, dx * dx / 6, solver::Scheme::split); };
  const Cable coarse = split(1), usual = split(0.6), fine = split(0.3);
  EXPECT_NEAR(coarse.conduction_velocity, 1.5991, 0.0001);
  EXPECT_NEAR(usual.conduction_velocity, 1.5904, 0.0001);
  EXPECT_NEAR(usual.apd, 36.704, 0.001);
  // Half a reaction back; the limit of small steps is 36.733.
  EXPECT_NEAR(usual.apd_of_beats.mean, 36.746, 0.002);
  EXPECT_NEAR(fine.conduction_velocity, 1.5888, 0.0002);
}

// At dx = 0.15 and dt = 0.01 a cable is stable and a sheet is not: the same cable as a plain loop.
double velocity_of_a_plain_cable(double dx, double dt) {
  const int n = static_cast<int>(std::lround(120 / dx)) + 1;
  const cell::AlievPanfilov<double> model;
  std::vector<double> V(n), r(n), V_next(n);
  for (int j = 0; j * dx <= 3 + 1e-9; ++j) V[j] = 1;
  double near = -1, far = -1;
  for (double t = 0; far < 0; t += dt) {
    for (int j = 0; j < n; ++j) {
      const double west = V[j > 0 ? j - 1 : 1], east = V[j < n - 1 ? j + 1 : n - 2];
      V_next[j] = V[j] + dt * ((west - 2 * V[j] + east) / (dx * dx) + model.excitation(V[j], r[j]));
      r[j] += dt * model.recovery(V[j], r[j]);
    }
    const auto crossing = [&](int j) { return t + dt * (0.5 - V[j]) / (V_next[j] - V[j]); };
    if (near < 0 && V_next[n / 3] >= 0.5) near = crossing(n / 3);
    if (far < 0 && V_next[2 * n / 3] >= 0.5) far = crossing(2 * n / 3);
    V.swap(V_next);
  }
  return (2 * n / 3 - n / 3) * dx / (far - near);
}

TEST(RigidFacts, ConductionVelocityUnderRefinement) {
  EXPECT_NEAR(velocity_of_a_plain_cable(0.6, 0.02), 1.5350, 0.00005);
  EXPECT_NEAR(run_cable(0.3, 0.02).conduction_velocity, 1.5608, 0.00005);
  EXPECT_NEAR(velocity_of_a_plain_cable(0.15, 0.01), 1.5767, 0.00005);
}

TEST(RigidFacts, CellFromHalfItsAmplitude) {
  EXPECT_NEAR(solver::time_to_fall({}, {.V = 0.5}, 0.1), 38.714, 0.0005);
}

TEST(RigidFacts, ActionPotentialOfAlievAndPanfilovsOwnParameters) {
  EXPECT_NEAR(solver::time_to_fall(solver::aliev_panfilov_cell(), {.V = 0.5}, 0.5), 25.643, 0.0005)
      << "they quote 25.58";
}

TEST(RigidFacts, DynamicRestitutionOfACell) {
  const auto points = solver::restitution({});
  const auto at = [&](int cycle_length) { return points.at(60 - cycle_length); };
  using Capture = solver::RestitutionPoint::Capture;
  ASSERT_EQ(points.size(), 31);
  EXPECT_NEAR(at(60).apd(), 31.42, 0.01);
  EXPECT_NEAR(at(44).apd(), 27.55, 0.01);
  EXPECT_NEAR(at(34).apd(), 23.7, 0.05);
  for (int length = 31; length <= 60; ++length) EXPECT_EQ(at(length).capture, Capture::one_to_one) << length;
  for (int length = 32; length <= 60; ++length) EXPECT_FALSE(at(length).alternates) << length;
  EXPECT_TRUE(at(31).alternates);
  EXPECT_EQ(at(30).capture, Capture::two_to_one);
}

// The standard settled spiral of the 121x121 sheet.
solver::Scene p15() {
  solver::Scene scene;
  scene.grid = {121, 121, 0.6};
  scene.time = {0.02, 400, 10};
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.initial.offset = {-5, 40};
  solver::Precondition settle{270, false, scene.excitation, scene.tension};
  settle.excitation.mu1 = 0.15;
  scene.initial.preconditions = {settle};
  scene.output.tips_every = 0.2;
  scene.output.probes = {{30, 30}, {30, 90}, {90, 30}, {90, 90}};
  return scene;
}

TEST(RigidFacts, SettledSpiralP15) {
  const solver::Scene scene = p15();
  RecordingSink sink;
  solver::RunSummary summary;
  solver::run(scene, solver::make_initial_state(scene), sink, summary);

  EXPECT_NEAR(summary.observables.period.mean, 26.816, 0.02);
  EXPECT_NEAR(summary.observables.period.sd, 0.37, 0.03);
  EXPECT_EQ(summary.observables.tips.mean, 1);
  EXPECT_EQ(summary.observables.tips.sd, 0);
  EXPECT_FALSE(summary.observables.breakup_tu);
  EXPECT_FALSE(summary.observables.death_tu);

  // The core: the tip's circle over whole turns, once the change of mu1 has settled.
  double x = 0, y = 0;
  std::vector<solver::Tip> tips;
  for (const auto& sample : sink.tip_samples)
    if (sample.t >= 200 && sample.t < 200 + 7 * 26.84) tips.push_back(sample.tips.at(0));
  for (const auto& tip : tips) x += tip.x / tips.size(), y += tip.y / tips.size();
  double radius = 0;
  for (const auto& tip : tips) radius += std::hypot(tip.x - x, tip.y - y) / tips.size();
  EXPECT_NEAR(x, 35.04, 0.05);
  EXPECT_NEAR(y, 41.03, 0.05);
  EXPECT_NEAR(radius, 1.77, 0.02);
}

}  // namespace
}  // namespace myowave
