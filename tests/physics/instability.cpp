// Runs with unstable steps: each outcome occurs, and each has an error or a warning.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "kernels/observe/state_check.hpp"
#include "solver/base/error.hpp"
#include "solver/coupling/electromechanics.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using solver::InitialState;
using solver::OnUnstable;
using solver::Scene;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Space = Kokkos::DefaultExecutionSpace;

Scene spiral(int n, double dt, double t_end) {
  Scene scene;
  scene.grid = {n, n, 0.6};
  scene.time = {dt, t_end, 10};
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.every = scene.output.tips_every = scene.output.probes_every = 50 * dt;
  return scene;
}

struct Outcome {
  InitialState state;
  solver::RunSummary summary;
  test::RecordingSink sink;
  std::string failure;  // empty where there was none
};

Outcome run(const Scene& scene, const InitialState& initial) {
  Outcome outcome;
  try {
    outcome.state = solver::run(scene, initial, outcome.sink, outcome.summary);
  } catch (const solver::NumericalFailure& failure) {
    outcome.failure = failure.what();
  }
  return outcome;
}
Outcome run(const Scene& scene) { return run(scene, solver::make_initial_state(scene)); }

double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0, norm = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    difference += (a[n] - b[n]) * (a[n] - b[n]);
    norm += b[n] * b[n];
  }
  return std::sqrt(difference / norm);
}

// Takes steps that a run would refuse. Checks the state every 2 t.u.
struct Unguarded {
  std::optional<std::string> problem;
  double t = 0, largest_noise = 0, largest_V = 0;  // noise and V from t = 2 on
};

// For the tables of solver/studies/unstable_steps.md: --gtest_output=json:FILE.
void record(double dt, const Unguarded& seen) {
  ::testing::Test::RecordProperty(
      fmt::format("dt_{:.0f}e-4", 1e4 * dt),
      fmt::format("t = {:.1f}: noise {:.4f}, V {:.4f}", seen.t, seen.largest_noise, seen.largest_V));
}

template <class Real = double>
Unguarded step_unguarded(const Scene& scene) {
  solver::PhaseSeconds phases;
  solver::MechanicsStatistics statistics;
  solver::Electromechanics<Space, Real> sheet(solver::Execution{}, scene, solver::make_initial_state(scene),
                                              phases, statistics);
  const auto stretch = static_cast<std::int64_t>(std::ceil(2 / scene.time.dt));
  Unguarded seen;
  for (std::int64_t step = 0; seen.t < scene.time.t_end && !seen.problem;) {
    sheet.advance(step, stretch);
    step += stretch;
    seen.t = static_cast<double>(step) * scene.time.dt;
    seen.problem = sheet.check_state(seen.t, scene.time.dt);
    const auto state = sheet.download();
    EnsembleField<double, Kokkos::HostSpace> V("V", 1, state.rows, state.columns);
    std::copy(state.V.begin(), state.V.end(), V.data());
    const auto range = observe::inspect_state(Kokkos::DefaultHostExecutionSpace(), V, V, V);
    seen.largest_noise = std::max(seen.largest_noise, range.noise);
    seen.largest_V = std::max(seen.largest_V, range.max_V);
  }
  return seen;
}

// The three outcomes of model.md's rigid sheet: bound 0.068, blown up from 0.086 on.
TEST(Instability, BelowTheBoundTheSheetIsRight) {
  for (const double dt : {0.02, 0.06, 0.0675}) {
    const Unguarded seen = step_unguarded(spiral(61, dt, 40));
    record(dt, seen);
    EXPECT_FALSE(seen.problem) << "dt = " << dt << ": " << *seen.problem;
    EXPECT_LT(seen.largest_noise, 0.006) << "dt = " << dt;
    EXPECT_LT(seen.largest_V, 1) << "dt = " << dt;
  }
  EXPECT_FALSE(step_unguarded<float>(spiral(61, 0.06, 40)).problem);
}

TEST(Instability, PastTheBoundWrongFiniteStatesAreFound) {
  for (const double dt : {0.073, 0.077, 0.081, 0.085}) {
    for (const bool single : {false, true}) {
      const Scene scene = spiral(61, dt, 20);
      const Unguarded seen = single ? step_unguarded<float>(scene) : step_unguarded(scene);
      ASSERT_TRUE(seen.problem) << "dt = " << dt;
      if (!single) record(dt, seen);
      EXPECT_THAT(*seen.problem, AllOf(HasSubstr("t = "), HasSubstr("node (row "), HasSubstr("V = ")));
      EXPECT_THAT(*seen.problem,
                  ::testing::AnyOf(HasSubstr("V alternates by 0."), HasSubstr("V is outside of")));
      EXPECT_TRUE(std::isfinite(seen.largest_V));
      EXPECT_GT(seen.largest_noise, 0.03);
    }
  }
}

TEST(Instability, StatesThatBlowUpAreFound) {
  const Unguarded seen = step_unguarded(spiral(61, 0.15, 20));
  ASSERT_TRUE(seen.problem);
  EXPECT_THAT(*seen.problem, HasSubstr("is not finite at node (row "));
}

// Strong tension and a load under which elements shrink to a fifth of their area: no alarm either.
TEST(Instability, ContractedSheetsAreValid) {
  for (const auto metric : {solver::MetricForm::conservative, solver::MetricForm::expanded}) {
    Scene scene = spiral(61, 0.02, 30);
    scene.metric = metric;
    scene.mechanics.emplace().p = 30;
    scene.tension = {.law = solver::TensionLaw::printed, .k_Ta = 60};
    scene.on_unstable = OnUnstable::substep;
    const Outcome outcome = run(scene);
    EXPECT_EQ(outcome.failure, "");
    EXPECT_LT(outcome.summary.mechanics.min_J, 0.35);
    EXPECT_LE(outcome.summary.largest_substeps, 3) << "only as many as the metric needs";
  }
}

// A front sharper than the grid has noise, but not of this kind: no alarm.
TEST(Instability, BadlyResolvedFrontsAreValid) {
  for (const double D : {0.2, 0.05, 0.01}) {
    Scene scene = spiral(41, 0, 20);
    scene.excitation.D = D;
    scene.time.dt = 0.95 * solver::largest_stable_dt(scene, 2);
    const Unguarded seen = step_unguarded(scene);
    record(scene.time.dt, seen);
    EXPECT_FALSE(seen.problem) << "D = " << D << ": " << *seen.problem;
    EXPECT_GT(seen.largest_noise, solver::largest_clean_noise) << "D = " << D;
  }
}

TEST(Instability, TheRangeOfACleanRun) {
  Scene scene;
  const InitialState rest{1, 2, {0, 0}, {0, 0}, {0, 0}};
  const auto at_rest = solver::clean_range(scene, rest);
  EXPECT_EQ(at_rest.min_V, 0);
  EXPECT_EQ(at_rest.max_V, 1);
  EXPECT_EQ(at_rest.min_r, 0);
  // 8 V (V - 0.1)(V - 1) = 2.5 + 0.5 at the top, = -1.25 = 8 (-0.3)(-0.4)(-1.3) - 0.002 at the bottom
  scene.stimuli = {{.amplitude = 2.5}, {.amplitude = 0.5}, {.amplitude = -1.248}};
  const auto driven = solver::clean_range(scene, rest);
  EXPECT_NEAR(8 * driven.max_V * (driven.max_V - 0.1) * (driven.max_V - 1), 3, 1e-9);
  EXPECT_GT(driven.max_V, 1.2);
  EXPECT_NEAR(driven.min_V, -0.3, 1e-12);
  // V above 1 + b draws r down, not below where eps + mu1 r / (mu2 + V) = 0
  EXPECT_NEAR(driven.min_r, -0.01 * (0.3 + driven.max_V) / 0.12, 1e-12);
  // the state itself may be beyond
  EXPECT_EQ(solver::clean_range(scene, {1, 2, {0, 4}, {0, 0}, {0, 0}}).max_V, 4);
}

// A current of 3 holds V at 1.26, where the reaction is 2.3 times as steep as at V = 1: dt = 0.06 is stable
// without it and unstable with it. The bound checked before a run does not show this; the state does.
Scene strong_current(double dt) {
  Scene scene = spiral(41, dt, 12);
  scene.excitation.b = 0.5;  // r stays above 0 at that V
  scene.stimuli.push_back({.start = 0, .duration = 9, .amplitude = 3});
  return scene;
}

TEST(Instability, InstabilityBelowTheBoundStopsTheRun) {
  const Outcome stopped = run(strong_current(0.06));
  EXPECT_THAT(stopped.failure, AllOf(HasSubstr("t = "), HasSubstr("node (row "),
                                     HasSubstr("Use a smaller time.dt"), HasSubstr("on_unstable")));
  EXPECT_GT(stopped.summary.steps, 0);
  EXPECT_LE(stopped.summary.steps, 150) << "found within 100 steps of the current's start";
}

TEST(Instability, SubstepsHealIt) {
  Scene scene = strong_current(0.06);
  scene.on_unstable = OnUnstable::substep;
  const Outcome healed = run(scene);
  EXPECT_EQ(healed.failure, "");
  EXPECT_GT(healed.summary.substepped_steps, 0);
  EXPECT_LT(healed.summary.substepped_steps, healed.summary.steps) << "whole steps again after the pulse";
  EXPECT_EQ(healed.summary.steps, 200);
  EXPECT_THAT(healed.summary.warnings, ElementsAre(HasSubstr("steps were divided into")));
  EXPECT_EQ(healed.summary.largest_substeps, 2);
  const Outcome fine = run(strong_current(0.02));
  EXPECT_EQ(fine.failure, "");
  // measured: 0.014 and 0.019, of dt = 0.06 against 0.02
  EXPECT_LT(relative_difference(healed.state.V, fine.state.V), 0.03);
  EXPECT_LT(relative_difference(healed.state.r, fine.state.r), 0.03);
}

// The sheet contracts so far that dt = 0.05 is past the bound of its metric.
Scene contracting(double dt, double t_end) {
  Scene scene = spiral(61, dt, t_end);
  scene.mechanics.emplace().interval = static_cast<int>(std::lround(0.8 / dt));
  scene.tension.law = solver::TensionLaw::printed;
  scene.mechanics->p = 0;
  return scene;
}

TEST(Instability, AContractionPastTheBoundStopsOrIsSubstepped) {
  constexpr double t_end = 16;
  Scene scene = contracting(0.05, t_end);
  const Outcome stopped = run(scene);
  EXPECT_THAT(stopped.failure,
              AllOf(HasSubstr("past the stability bound"), HasSubstr("tr C^-1"), HasSubstr("\"substep\"")));
  scene.on_unstable = OnUnstable::substep;
  const Outcome healed = run(scene);
  EXPECT_EQ(healed.failure, "");
  EXPECT_GT(healed.summary.substepped_steps, 0);
  EXPECT_GE(healed.summary.largest_substeps, 2);
  EXPECT_LE(healed.summary.largest_substeps, 4);
  EXPECT_EQ(healed.summary.steps, 320);
  // What is left is the first-order error of the whole steps.
  const Outcome fine = run(contracting(0.02, t_end));
  EXPECT_EQ(fine.failure, "");
  EXPECT_LT(relative_difference(healed.state.V, fine.state.V), 0.01);  // measured: 0.0049
}

TEST(Instability, WithoutInstabilitySubstepIsBitwiseIdentical) {
  for (const bool deforms : {false, true}) {
    Scene scene = deforms ? contracting(0.02, 6) : spiral(41, 0.06, 12);
    scene.output.probes = {{10, 10}, {20, 25}};
    const Outcome stop = run(scene);
    scene.on_unstable = OnUnstable::substep;
    const Outcome substep = run(scene);
    EXPECT_EQ(stop.failure, "");
    EXPECT_EQ(substep.state.V, stop.state.V);
    EXPECT_EQ(substep.state.r, stop.state.r);
    EXPECT_EQ(substep.state.Ta, stop.state.Ta);
    EXPECT_EQ(substep.summary.substepped_steps, 0);
    EXPECT_THAT(substep.summary.warnings, IsEmpty());
  }
}

// r = -0.1 in a sheet at rest is below -eps mu2 / mu1 = -0.025: the exact solution runs away too.
TEST(Instability, InstabilityOfTheEquationsEndsTheRun) {
  Scene scene;
  scene.grid = {11, 11, 0.6};
  scene.time.t_end = 40;
  InitialState state = solver::make_initial_state(scene);
  std::fill(state.r.begin(), state.r.end(), -0.1);
  EXPECT_THAT(run(scene, state).failure, HasSubstr("r is outside of -0.15 to inf"));
  scene.on_unstable = OnUnstable::substep;
  const Outcome outcome = run(scene, state);
  EXPECT_THAT(outcome.failure, AllOf(HasSubstr("no valid state was found with up to 64 substeps"),
                                     HasSubstr("r is outside of -0.15 to inf")));
  EXPECT_GT(outcome.summary.steps, 50) << "it does not start there";
}

TEST(Instability, StrongTensionWarns) {
  Scene scene = contracting(0.01, 4);
  scene.tension.k_Ta = 75;
  const Outcome outcome = run(scene);
  EXPECT_EQ(outcome.failure, "");
  ASSERT_EQ(outcome.summary.warnings.size(), 2U);
  EXPECT_THAT(outcome.summary.warnings[0], HasSubstr("tension.k_Ta = 75 kPa is above 60 kPa"));
  EXPECT_THAT(outcome.summary.warnings[1], HasSubstr("the active tension has reached"));
}

std::string refusal(const Scene& scene, const InitialState& state) {
  solver::OutputSink nowhere;
  solver::RunSummary summary;
  try {
    solver::run(scene, state, nowhere, summary);
  } catch (const solver::InputError& error) {
    return error.what();
  }
  return "was not refused";
}

TEST(Refusal, OfStatesThatRunAway) {
  Scene scene;
  scene.grid = {2, 3, 0.6};
  scene.time.t_end = 0.1;
  const auto start = [](double V, double r) {
    return InitialState{2, 3, {0, 0, 0, 0, V, 0}, {0, 0, 0, 0, r, 0}, std::vector<double>(6)};
  };
  EXPECT_EQ(refusal(scene, start(0, -0.02)), "was not refused");
  EXPECT_EQ(
      refusal(scene, start(0.5, -0.12)),
      "the initial state at node (row 1, column 1), V = 0.5, r = -0.12 runs away: r below -eps (mu2 + V) / "
      "mu1 falls without end, below -0.11 at every V. Raise r there, or excitation.eps");
  EXPECT_EQ(
      refusal(scene, start(-0.31, 0.5)),
      "the initial state at node (row 1, column 1), V = -0.31, r = 0.5 is at or below -excitation.mu2 = "
      "-0.3, the pole of the recovery rate eps + mu1 r / (mu2 + V)");
  scene.excitation.mu2 = 0.001;
  EXPECT_EQ(
      refusal(scene, start(0, 1.5)),
      "the initial state at node (row 1, column 1), V = 0, r = 1.5 recovers at the rate eps + mu1 r / (mu2 "
      "+ V) = 180 per t.u.: one step of time.dt = 0.02 would throw r past 0. Set time.dt to 0.0055 or "
      "less, or use a larger excitation.mu2");
  EXPECT_EQ(refusal(scene, start(1, 1.5)), "was not refused");
}

}  // namespace
}  // namespace myowave
