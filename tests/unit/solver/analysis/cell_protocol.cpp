#include "solver/analysis/cell_protocol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/base/error.hpp"

namespace myowave::solver {
namespace {

using Capture = RestitutionPoint::Capture;

// A cell whose V falls as exp(-t): V_t = -r V with r = 1, constant because eps = mu1 = 0.
PacedCell decaying_cell(double dt) {
  PacedCell cell;
  cell.excitation = {{.k = 0, .a = 0.1, .b = 0.1, .eps = 0, .mu1 = 0}};
  cell.dt = dt;
  return cell;
}

TEST(CellProtocol, TimeToFallOfAnExponential) {
  EXPECT_NEAR(time_to_fall(decaying_cell(1e-4), {.V = 1, .r = 1}, 0.1), std::log(10.0), 2e-4);
  // Euler: V_n = (1 - dt)^n, so 0.9 and 0.81 at dt = 0.1; 0.855 is half-way between them
  EXPECT_NEAR(time_to_fall(decaying_cell(0.1), {.V = 1, .r = 1}, 0.855), 0.15, 1e-12);
}

TEST(CellProtocol, ALevelThatIsNotReachedIsAFailure) {
  EXPECT_THROW(time_to_fall(decaying_cell(0.1), {.V = 1, .r = 0}, 0.5), NumericalFailure);
}

TEST(CellProtocol, CapacitanceSlowsOnlyThePotential) {
  PacedCell cell = decaying_cell(1e-4);
  cell.excitation.C_m = 2;
  EXPECT_NEAR(time_to_fall(cell, {.V = 1, .r = 1}, 0.1), 2 * std::log(10.0), 2e-4);
}

TEST(CellProtocol, CourseIsSampledToTheEndOfTheLastCycle) {
  const CellCourse course = pace_cell({}, 40, 3, 0.1);
  ASSERT_EQ(course.t.size(), 1201);
  EXPECT_EQ(course.t.front(), 0);
  EXPECT_NEAR(course.t.back(), 120, 1e-9);
  EXPECT_EQ(course.V.front(), 0);
  ASSERT_EQ(course.V.size(), 1201);
  ASSERT_EQ(course.Ta.size(), 1201);
  ASSERT_EQ(course.beats.size(), 3);
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(course.beats[n].upstroke, 40 * n + 0.18, 0.05);
  EXPECT_NEAR(course.beats[0].period, 40, 0.05);
  EXPECT_TRUE(std::isnan(course.beats[2].period));
  EXPECT_NEAR(course.beats[1].di, course.beats[1].period - course.beats[1].apd90, 1e-12);
}

// The paper's Fig 2a, paced at 330 ms: V peaks at 19 ms, the tension at 185 ms.
TEST(CellProtocol, DelayedTensionPeaksLongAfterThePotential) {
  PacedCell cell;
  cell.amplitude = 0.5;
  cell.duration = 1;
  const auto peaks = [](const CellCourse& course) {
    const auto at = [&](const std::vector<double>& values) {
      const auto last_cycle = values.begin() + 49 * 1650;
      return 0.02 * static_cast<double>(std::max_element(last_cycle, values.end()) - last_cycle);
    };
    return std::pair{at(course.V), at(course.Ta)};
  };
  const auto [V_peak, Ta_peak] = peaks(pace_cell(cell, 33, 50, 0.02));
  EXPECT_NEAR(V_peak, 1.9, 0.1);
  EXPECT_NEAR(Ta_peak, 18.5, 0.1);
  cell.tension.law = TensionLaw::none;
  EXPECT_EQ(pace_cell(cell, 33, 1, 0.02).Ta.back(), 0);
}

// Pacing at 312 ms of 12.9 ms a t.u. (Fig 1a): the first action potential, from rest, outlasts the cycle and
// blocks the second pulse; each pulse after it captures.
TEST(CellProtocol, AlievAndPanfilovsCellFollowsItsPacing) {
  const double length = 312 / aliev_panfilov_ms_per_tu;
  const CellCourse course = pace_cell(aliev_panfilov_cell(), length, 20, 0.1);
  ASSERT_EQ(course.beats.size(), 19);
  EXPECT_NEAR(course.beats[0].period, 2 * length, 0.01);
  EXPECT_NEAR(course.beats[17].period, length, 0.001);
  EXPECT_NEAR(course.beats[18].apd, 13.39, 0.02);
}

// Slower recovery: longer action potentials, and 2:1 at longer cycles.
TEST(CellProtocol, RestitutionWithSlowRecovery) {
  RestitutionProtocol protocol;
  protocol.cell.excitation.mu1 = 0.07;
  const auto points = restitution(protocol);
  EXPECT_NEAR(points.front().apd(), 38.66, 0.05);
  EXPECT_EQ(points.front().capture, Capture::one_to_one);
  for (const auto& point : points) {
    if (point.cycle_length >= 50) {
      EXPECT_EQ(point.capture, Capture::one_to_one) << point.cycle_length;
      EXPECT_NEAR(point.di() + point.apd90(), point.cycle_length, 0.01) << point.cycle_length;
    }
    if (point.cycle_length <= 40) {
      EXPECT_EQ(point.capture, Capture::two_to_one) << point.cycle_length;
    }
  }
}

TEST(CellProtocol, InvalidLengthsAreRefused) {
  EXPECT_THROW(pace_cell({}, 0.001, 1, 1), InputError);
  EXPECT_THROW(pace_cell({}, 0.1, 1, 0.02), InputError) << "the pulse lasts 0.2";
  EXPECT_THROW(pace_cell({}, 30, 1, 0.001), InputError);
  RestitutionProtocol up;
  up.longest = 20;
  EXPECT_THROW(restitution(up), InputError);
  RestitutionProtocol still;
  still.step = 0;
  EXPECT_THROW(restitution(still), InputError);
}

}  // namespace
}  // namespace myowave::solver
