// Properties of every run, whatever it models.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <regex>
#include <string>

#include "solver/base/error.hpp"
#include "solver/coupling/electromechanics.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/run/run.hpp"
#include "tests/support/allclose.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using solver::InitialState;
using solver::Scene;
using test::RecordingSink;
using ::testing::HasSubstr;
using testing_support::all_close;

Scene spiral(int n) {
  Scene scene;
  scene.grid = {n, n, 0.6};
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  return scene;
}

template <class Failure>
std::string message_of(const Scene& scene, const InitialState& initial) {
  try {
    test::recorded_run(scene, initial);
  } catch (const Failure& failure) {
    return failure.what();
  }
  ADD_FAILURE() << "no failure";
  return {};
}

double number_after(const std::string& text, const std::string& words) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(words + R"(([-+0-9.e]+))"))) {
    ADD_FAILURE() << "no '" << words << "' in: " << text;
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::stod(match[1]);
}

TEST(RunInvariants, TheSameRunTwiceIsBitwiseIdentical) {
  Scene scene = spiral(61);
  scene.time.t_end = 10;
  scene.mechanics.emplace();
  scene.mechanics->interval = 25;
  for (const auto precision : {solver::Precision::float64, solver::Precision::float32}) {
    scene.precision = precision;
    const test::RecordedRun first = test::recorded_run(scene), second = test::recorded_run(scene);
    EXPECT_EQ(first.state.V, second.state.V);
    EXPECT_EQ(first.state.r, second.state.r);
    EXPECT_EQ(first.state.Ta, second.state.Ta);
    EXPECT_EQ(first.sink.nodes, second.sink.nodes);
    EXPECT_EQ(first.summary.mechanics.newton_iterations, second.summary.mechanics.newton_iterations);
  }
}

// How often a run is sampled must not change it.
TEST(RunInvariants, ObservationDoesNotChangeTheRun) {
  Scene scene = spiral(61);
  scene.time.t_end = 10;
  scene.mechanics.emplace();
  const test::RecordedRun seldom = test::recorded_run(scene);
  scene.output.every = 0.14;
  scene.output.tips_every = 0.06;
  scene.output.probes_every = 0.02;
  scene.output.probes = {{3, 4}, {30, 30}};
  const test::RecordedRun often = test::recorded_run(scene);
  EXPECT_EQ(seldom.state.V, often.state.V);
  EXPECT_EQ(seldom.sink.nodes, often.sink.nodes);
  EXPECT_EQ(often.sink.probe_samples.size(), 501U);
  EXPECT_EQ(seldom.summary.mechanics.solves, often.summary.mechanics.solves);
}

// A front that starts at the left end of a strip, and the same with a stimulus of amplitude 0, with which
// every step is taken by itself.
TEST(RunInvariants, StepsInTilesAreBitwiseIdenticalToSingleSteps) {
  Scene strip;
  strip.grid = {41, 261, 0.6};
  strip.time.t_end = 12;
  strip.stimuli.push_back({.amplitude = 2, .shape = solver::Stimulus::Shape::block});
  strip.stimuli[0].columns = {0, 5};
  strip.stimuli[0].rows = {0, strip.grid.rows - 1};
  strip.output.probes = {{20, 4}, {20, 30}, {0, 259}};
  strip.output.probes_every = 0.1;
  for (const auto precision : {solver::Precision::float64, solver::Precision::float32})
    for (const bool deforms : {false, true}) {
      Scene scene = strip;
      scene.precision = precision;
      if (deforms) scene.mechanics.emplace().interval = 40;
      const test::RecordedRun in_tiles = test::recorded_run(scene);
      scene.stimuli.push_back({.duration = 2 * scene.time.t_end, .amplitude = 0});
      const test::RecordedRun single = test::recorded_run(scene);
      EXPECT_EQ(in_tiles.state.V, single.state.V);
      EXPECT_EQ(in_tiles.state.r, single.state.r);
      EXPECT_EQ(in_tiles.state.Ta, single.state.Ta);
      EXPECT_EQ(in_tiles.sink.nodes, single.sink.nodes);
      ASSERT_EQ(in_tiles.sink.probe_samples.size(), 121U);
      for (std::size_t n = 0; n < in_tiles.sink.probe_samples.size(); ++n)
        EXPECT_EQ(in_tiles.sink.probe_samples[n].values, single.sink.probe_samples[n].values);
      EXPECT_GT(in_tiles.state.V[20 * 261 + 20], 0.9) << "no front";
    }
}

TEST(RunInvariants, Float32FollowsFloat64) {
  Scene scene = spiral(61);
  scene.time.t_end = 50;
  for (const bool deforms : {false, true}) {
    if (deforms) scene.mechanics.emplace();
    scene.precision = solver::Precision::float64;
    const test::RecordedRun exact = test::recorded_run(scene);
    scene.precision = solver::Precision::float32;
    const test::RecordedRun rounded = test::recorded_run(scene);
    EXPECT_TRUE(all_close(rounded.state.V, exact.state.V, 61, {.absolute = 4e-6}));
    EXPECT_TRUE(all_close(rounded.state.r, exact.state.r, 61, {.absolute = 8e-6}));
    // a node whose V crosses the tension's threshold one step earlier or later is off by (1 - 0.1) Ta dt
    EXPECT_TRUE(all_close(rounded.state.Ta, exact.state.Ta, 61, {.absolute = 0.02}));
    EXPECT_TRUE(all_close(rounded.sink.nodes, exact.sink.nodes, 2, {.absolute = 1e-5}));
    EXPECT_GT(*std::max_element(exact.state.V.begin(), exact.state.V.end()), 0.5) << "the waves died";
  }
}

TEST(RunInvariants, StepPastTheStabilityBoundIsRefused) {
  Scene scene = spiral(21);
  const double bound = 2 / (8 / 0.36 + 7.2);
  EXPECT_NEAR(solver::largest_stable_dt(scene, 2), bound, 1e-15);
  scene.time.dt = bound * (1 - 1e-9);
  scene.time.t_end = 20 * bound;
  EXPECT_EQ(test::recorded_run(scene).summary.steps, 20);
  scene.time.dt = bound * (1 + 1e-9);
  const auto message = message_of<solver::InputError>(scene, solver::make_initial_state(scene));
  EXPECT_THAT(message, HasSubstr("time.dt"));
  EXPECT_NEAR(number_after(message, "stability bound "), bound, 1e-7);
  // the proposed step works
  scene.time.dt = number_after(message, "Set time.dt to ");
  EXPECT_GT(scene.time.dt, 0.95 * bound);
  EXPECT_EQ(test::recorded_run(scene).summary.steps, 20);
}

// C_m and D scale the bound as they scale the equation.
TEST(RunInvariants, StabilityBoundFollowsTheMedium) {
  Scene scene;
  const double usual = solver::largest_stable_dt(scene, 2);
  scene.excitation.C_m = 3;
  EXPECT_DOUBLE_EQ(solver::largest_stable_dt(scene, 2), 3 * usual);
  scene.excitation = {};
  scene.excitation.D = 4;
  scene.grid.dx = 1.2;
  EXPECT_DOUBLE_EQ(solver::largest_stable_dt(scene, 2), usual);
}

// The law "none" drops only Ta: V and r are bitwise identical, in tiles and in single steps.
TEST(RunInvariants, WithoutTensionVAndRAreTheSame) {
  Scene scene = spiral(61);
  scene.time.t_end = 20;
  scene.output.probes = {{15, 15}, {30, 45}};
  scene.stimuli.push_back({.start = 5, .amplitude = 0.5});
  for (const bool deforms : {false, true}) {
    if (deforms) scene.mechanics.emplace().contraction = false;
    scene.tension.law = solver::TensionLaw::delayed;
    const test::RecordedRun with = test::recorded_run(scene);
    scene.tension.law = solver::TensionLaw::none;
    const test::RecordedRun without = test::recorded_run(scene);
    EXPECT_EQ(without.state.V, with.state.V);
    EXPECT_EQ(without.state.r, with.state.r);
    EXPECT_EQ(without.state.Ta, std::vector<double>(with.state.Ta.size()));
    EXPECT_GT(*std::max_element(with.state.Ta.begin(), with.state.Ta.end()), 10);
    EXPECT_THAT(without.summary.plan.in_words(),
                ::testing::Not(::testing::Contains(HasSubstr("active tension"))));
    EXPECT_LT(solver::memory_bytes(scene), [&] {
      Scene other = scene;
      other.tension.law = solver::TensionLaw::delayed;
      return solver::memory_bytes(other);
    }());
  }
}

TEST(RunInvariants, ContractionPastTheStabilityBoundStopsTheRun) {
  Scene scene;
  scene.grid = {41, 41, 0.6};
  scene.time = {0.06, 30, 10};
  scene.tension.law = solver::TensionLaw::printed;
  scene.tension.k_Ta = 55;
  scene.mechanics.emplace();
  scene.mechanics->interval = 10;
  InitialState state = solver::make_initial_state(scene);
  std::fill(state.V.begin(), state.V.end(), 1.0);
  const auto message = message_of<solver::NumericalFailure>(scene, state);

  const double bound = number_after(message, "stability bound "),
               trace = number_after(message, "tr C\\^-1 is ");
  const double dt = number_after(message, "Set time.dt to ");
  EXPECT_LT(bound, 0.06);
  EXPECT_NEAR(bound, 2 / (4 * trace / 0.36 + 7.2), 1e-6);
  EXPECT_GT(number_after(message, "smallest J "), 0);
  // at the first solve with tension, and the message has a step that would work there
  EXPECT_NEAR(number_after(message, "t = "), 0.6, 1e-9);
  EXPECT_LT(dt, bound);
  EXPECT_GT(dt, 0.8 * bound);
}

TEST(RunInvariants, InitialStateOfAnotherSizeIsRefused) {
  Scene scene = spiral(21);
  const InitialState state = solver::make_initial_state(scene);
  scene.grid.columns = 22;
  EXPECT_THAT(message_of<solver::InputError>(scene, state), HasSubstr("21 x 21"));
}

TEST(RunInvariants, NonFiniteStartIsReportedAtOnce) {
  Scene scene = spiral(21);
  scene.time.t_end = 5;
  InitialState state = solver::make_initial_state(scene);
  state.r[7 * 21 + 11] = std::numeric_limits<double>::quiet_NaN();
  const auto message = message_of<solver::NumericalFailure>(scene, state);
  EXPECT_THAT(message, HasSubstr("t = 0 "));
  EXPECT_THAT(message, HasSubstr("row 7, column 11"));
}

// A current so large that one step takes V out of the range of the equations, where it blows up.
solver::Stimulus lightning(double start) {
  solver::Stimulus s;
  s.start = start;
  s.duration = 0.02;
  s.amplitude = 200;
  s.shape = solver::Stimulus::Shape::block;
  s.columns = {11, 11};
  s.rows = {7, 7};
  return s;
}

TEST(RunInvariants, AStateThatBlowsUpIsReportedWithinAnInterval) {
  Scene scene = spiral(21);
  scene.time.t_end = 50;
  for (const double start : {3.96, 3.98}) {
    scene.stimuli = {lightning(start)};  // step 198 or 199; a check every 100
    const auto message = message_of<solver::NumericalFailure>(scene, solver::make_initial_state(scene));
    EXPECT_THAT(message, HasSubstr("t = 4 t.u.: V is outside of"));
    EXPECT_THAT(message, HasSubstr("row 7, column 11"));
  }
  scene.stimuli = {lightning(2.04)};
  EXPECT_THAT(message_of<solver::NumericalFailure>(scene, solver::make_initial_state(scene)),
              HasSubstr("t = 4 t.u.: the excitation is not finite"));

  // with mechanics the checks come before its solves, which must not get non-finite values
  scene.mechanics.emplace();
  scene.mechanics->interval = 30;
  scene.stimuli = {lightning(1.76)};
  const auto message = message_of<solver::NumericalFailure>(scene, solver::make_initial_state(scene));
  EXPECT_THAT(message, HasSubstr("t = 1.8 "));
  EXPECT_THAT(message, HasSubstr("row 7, column 11"));
}

TEST(RunInvariants, SummaryReportsTheProgressOfAFailedRun) {
  Scene scene = spiral(21);
  scene.time.t_end = 50;
  scene.stimuli = {lightning(3.96)};
  RecordingSink sink;
  solver::RunSummary summary;
  EXPECT_THROW(solver::run(scene, solver::make_initial_state(scene), sink, summary),
               solver::NumericalFailure);
  EXPECT_EQ(summary.steps, 200);
  EXPECT_DOUBLE_EQ(summary.t, 4);
  EXPECT_EQ(sink.tip_samples.back().t, 3);
}

// A precondition is a separate run before t = 0, without stimuli and mechanics, with its own parameters.
TEST(RunInvariants, PreconditionsComeBeforeTimeZero) {
  Scene scene = spiral(41);
  scene.time.t_end = 6;
  scene.mechanics.emplace();
  solver::Stimulus pulse;
  pulse.start = 1;
  pulse.amplitude = 0.5;
  scene.stimuli = {pulse};
  scene.output.probes = {{10, 20}};
  solver::Precondition faster{8, false, scene.excitation, scene.tension}, weaker = faster;
  faster.excitation.mu1 = 0.15;
  weaker.duration = 3;
  weaker.tension.k_Ta = 20;

  Scene whole = scene;
  whole.initial.preconditions = {faster, weaker};
  const test::RecordedRun actual = test::recorded_run(whole);

  const auto stage = [&](const solver::Precondition& p) {
    Scene s = scene;
    s.mechanics.reset();
    s.stimuli.clear();
    s.time.t_end = p.duration;
    s.excitation = p.excitation;
    s.tension = p.tension;
    return s;
  };
  const InitialState first = test::recorded_run(stage(faster), solver::make_initial_state(scene)).state;
  const InitialState second = test::recorded_run(stage(weaker), first).state;
  const test::RecordedRun expected = test::recorded_run(scene, second);
  EXPECT_EQ(actual.state.V, expected.state.V);
  EXPECT_EQ(actual.state.Ta, expected.state.Ta);
  EXPECT_EQ(actual.sink.nodes, expected.sink.nodes);
  EXPECT_EQ(actual.summary.steps, 300);
  EXPECT_EQ(actual.summary.mechanics.solves, expected.summary.mechanics.solves);
  ASSERT_EQ(actual.sink.probe_samples.size(), 7U);
  EXPECT_EQ(actual.sink.probe_samples.front().t, 0);
  EXPECT_EQ(actual.sink.probe_samples.front().values[0], second.V[10 * 41 + 20]);
  EXPECT_DOUBLE_EQ(actual.sink.probe_samples.back().t, 6);
}

TEST(RunInvariants, ContractingPreconditionNeedsMechanics) {
  Scene scene = spiral(21);
  scene.initial.preconditions = {{1, true, scene.excitation, scene.tension}};
  EXPECT_THAT(message_of<solver::InputError>(scene, solver::make_initial_state(scene)),
              HasSubstr("mechanics"));
  scene.time.t_end = 1;
  scene.mechanics.emplace();
  scene.mechanics->contraction = false;
  EXPECT_NO_THROW(test::recorded_run(scene));
}

// The sheet's own symmetries: a centred disc knows none of the directions. The mesh is held at its
// middle, which all of them leave alone where the element counts are even.
TEST(RunInvariants, CentredStimulusKeepsTheSymmetryOfTheSquare) {
  constexpr int n = 41, elements = 4;
  Scene scene;
  scene.grid = {n, n, 0.6};
  scene.time.t_end = 16;
  scene.mechanics.emplace();
  scene.mechanics->interval = 20;
  scene.mechanics->tolerance = 1e-11;
  solver::Stimulus disc;
  disc.duration = 2;
  disc.amplitude = 0.8;
  disc.shape = solver::Stimulus::Shape::disc;
  disc.center = {20, 20};
  disc.radius = 5;
  scene.stimuli = {disc};
  for (const auto metric : {solver::MetricForm::conservative, solver::MetricForm::expanded}) {
    scene.metric = metric;
    const test::RecordedRun result = test::recorded_run(scene);
    const auto& V = result.state.V;
    const auto& x = result.sink.nodes;
    ASSERT_GT(*std::max_element(V.begin(), V.end()), 0.9);
    // far from an equal shrinking of all elements
    ASSERT_GT(result.sink.areas.back().max - result.sink.areas.back().min, 0.02);

    constexpr double middle = (n - 1) / 2 * 0.6;
    double worst_V = 0, worst_x = 0;
    for (const bool turn : {false, true})  // with the mirror, these make all eight
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const int k = turn ? j * n + (n - 1 - i) : i * n + (n - 1 - j);
          worst_V = std::max(worst_V, std::abs(V[i * n + j] - V[k]));
        }
    for (const bool turn : {false, true})
      for (int I = 0; I <= elements; ++I)
        for (int J = 0; J <= elements; ++J) {
          const double* a = &x[2 * (I * (elements + 1) + J)];
          const double* b = turn ? &x[2 * (J * (elements + 1) + elements - I)]
                                 : &x[2 * (I * (elements + 1) + elements - J)];
          const double a1 = a[0] - middle, a2 = a[1] - middle, b1 = b[0] - middle, b2 = b[1] - middle;
          // (x1, x2) goes to (-x2, x1), or to (-x1, x2)
          worst_x = std::max({worst_x, std::abs(b1 + (turn ? a2 : a1)), std::abs(b2 - (turn ? a1 : a2))});
        }
    EXPECT_LT(worst_V, 1e-8);
    EXPECT_LT(worst_x, 1e-8);
  }
}

}  // namespace
}  // namespace myowave
