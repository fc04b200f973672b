// Parameters at the ends of their ranges, and a million steps: a run is right, refused or stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "solver/excitation/stability.hpp"
#include "solver/studies/parameter_maps.hpp"

namespace myowave::solver {
namespace {

ParameterCase front(bool coupled = false) {
  ParameterCase one;
  one.scene.grid = {21, 21, 0.6};
  one.scene.time.t_end = 10;
  one.scene.initial.type = InitialSettings::Type::broken_front;
  if (coupled) one.scene.mechanics.emplace();
  return one;
}

bool handled(const ParameterResult& result) { return result.outcome != ParameterOutcome::wrong; }

TEST(ParameterMap, ThePaperIsRight) {
  for (const bool coupled : {false, true}) {
    const auto result = run_case(front(coupled));
    EXPECT_EQ(result.outcome, ParameterOutcome::right) << result.reason;
    EXPECT_LT(result.error, 0.01);
    EXPECT_LE(result.largest_V, 1);
  }
}

TEST(ParameterMap, WithoutRecoveryTheSheetStaysExcited) {
  ParameterCase one = front();
  one.scene.excitation.mu1 = one.scene.excitation.eps = 0;
  const auto result = run_case(one);
  EXPECT_EQ(result.outcome, ParameterOutcome::right) << result.reason;
  EXPECT_NEAR(result.largest_V, 1, 1e-4);
}

TEST(ParameterMap, RecoveryTooFastForTheStepIsReported) {
  ParameterCase one = front();
  for (const double mu2 : {1e-3, 1e-6}) {
    one.scene.excitation.mu2 = mu2;
    EXPECT_TRUE(handled(run_case(one))) << "mu2 = " << mu2;
  }
}

TEST(ParameterMap, FastCurrentsPastTheBoundAreRefusedWithIt) {
  ParameterCase one = front();
  for (const double k : {87.0, 111.0, 200.0}) {
    one.scene.excitation.k = k;
    const auto result = run_case(one);
    EXPECT_EQ(result.outcome, ParameterOutcome::refused) << "k = " << k;
    EXPECT_NE(result.reason.find("bound"), std::string::npos);
  }
}

TEST(ParameterMap, AStableStepThatCannotFollowTheReactionWarns) {
  ParameterCase one = front();
  one.scene.excitation.k = 70;
  const auto result = run_case(one);
  EXPECT_EQ(result.outcome, ParameterOutcome::warned) << result.error;
  EXPECT_NE(result.reason.find("too long to follow the reaction"), std::string::npos) << result.reason;
  EXPECT_TRUE(warnings_of({}).empty());
}

TEST(ParameterMap, AStepThatRoundingLosesWarns) {
  Scene scene;
  scene.time.dt = 1e-6;
  EXPECT_TRUE(warnings_of(scene).empty()) << "float64";
  scene.precision = Precision::float32;
  ASSERT_EQ(warnings_of(scene).size(), 1U);
  EXPECT_NE(warnings_of(scene)[0].find("too short for the precision"), std::string::npos);
}

TEST(ParameterMap, NegativeRecoveryAboveTheThresholdDiesOutAndBelowRunsAway) {
  ParameterCase one = front();
  one.scene.grid = {3, 3, 0.6};
  one.scene.time.t_end = 400;
  one.scene.initial.type = InitialSettings::Type::rest;
  const auto with_r = [&](double r) {
    one.prepare = [r](InitialState& state) { std::ranges::fill(state.r, r); };
    return run_case(one).outcome;
  };
  EXPECT_EQ(with_r(-0.024), ParameterOutcome::right) << "-eps mu2 / mu1 = -0.025";
  EXPECT_TRUE(with_r(-0.026) == ParameterOutcome::stopped || with_r(-0.026) == ParameterOutcome::refused);
}

TEST(ParameterMap, StimuliOfAnySizeAreRightOrReported) {
  for (const double amplitude : {-1e6, -10.0, 10.0, 1e3, 1e6, 1e300}) {
    ParameterCase one = front();
    one.scene.initial.type = InitialSettings::Type::rest;
    one.scene.stimuli.push_back({.start = 1, .amplitude = amplitude});
    EXPECT_TRUE(handled(run_case(one))) << "I_s = " << amplitude;
  }
}

TEST(ParameterMap, SheetsOfEveryShapeAreRight) {
  for (const auto& [rows, columns, cells] :
       {std::tuple{2, 2, 0}, {2, 30, 0}, {30, 2, 0}, {2, 2, 1}, {11, 11, 10}, {11, 31, 10}, {31, 11, 5}}) {
    ParameterCase one = front(cells > 0);
    one.scene.grid = {rows, columns, 0.6};
    if (cells > 0) one.scene.mechanics->cells_per_element = cells;
    const auto result = run_case(one);
    EXPECT_EQ(result.outcome, ParameterOutcome::right)
        << rows << " x " << columns << ": " << result.error << result.reason;
  }
}

TEST(ParameterMap, NoDiffusionIntervalOneAndFloat32AreRight) {
  ParameterCase one = front(true);
  one.scene.mechanics->interval = 1;
  one.scene.excitation.D = 0;
  one.scene.precision = Precision::float32;
  const auto result = run_case(one);
  EXPECT_EQ(result.outcome, ParameterOutcome::right) << result.error << result.reason;
}

// Rounding errors only: at most a hundred units in the last place after 10^6 steps.
TEST(MillionSteps, KeepTheSumOfADiffusingSheet) {
  EXPECT_NEAR(diffuse_on_held_sheet(Precision::float64, 9, 1'000'000).drift(), 0, 100 * DBL_EPSILON);
  EXPECT_NEAR(diffuse_on_held_sheet(Precision::float32, 9, 1'000'000).drift(), 0, 100 * FLT_EPSILON);
}

TEST(MillionSteps, LeaveNoDenormal) {
  for (const auto precision : {Precision::float64, Precision::float32}) {
    const double least = precision == Precision::float32 ? double(FLT_MIN) : DBL_MIN;
    const auto sheet = leave_alone(precision, 9, 1'000'000);
    for (const double V : sheet.state.V) {
      EXPECT_TRUE(V == 0 || std::abs(V) >= least) << V;
      EXPECT_LT(std::abs(V), 1e-30);
    }
    for (const double r : sheet.state.r) EXPECT_TRUE(r == 0 || std::abs(r) >= least) << r;
  }
}

}  // namespace
}  // namespace myowave::solver
