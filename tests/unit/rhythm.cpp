#include "solver/rhythm.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace myowave::solver {
namespace {

constexpr double dt = 0.02;

TEST(RunningStatistics, MeanAndSampleDeviationOfAHandCase) {
  RunningStatistics s;
  EXPECT_EQ(s.result().n, 0);
  s.add(3);
  EXPECT_EQ(s.result().n, 1);
  EXPECT_EQ(s.result().mean, 3);
  EXPECT_EQ(s.result().sd, 0);
  for (const double value : {5.0, 7.0, 9.0}) s.add(value);
  EXPECT_EQ(s.result().n, 4);
  EXPECT_DOUBLE_EQ(s.result().mean, 6);
  EXPECT_DOUBLE_EQ(s.result().sd, std::sqrt(20.0 / 3));
}

TEST(RunningStatistics, KeepsASmallSpreadOnALargeMean) {
  RunningStatistics s;
  for (int n = 0; n < 1000; ++n) s.add(1e9 + (n % 2));
  EXPECT_NEAR(s.result().sd, 0.5 * std::sqrt(1000.0 / 999), 1e-9);
}

// V = 0.5 + 0.45 sin(2 pi t / period)
void add_sine(PeriodMeter& meter, double period, double t_end) {
  for (int n = 0; n * dt < t_end; ++n) {
    const double t = n * dt, V = 0.5 + 0.45 * std::sin(2 * std::numbers::pi * t / period);
    meter.add(t, std::array{V});
  }
}

TEST(PeriodMeter, FindsAKnownPeriodBetweenTheSteps) {
  PeriodMeter meter(1, 0);
  add_sine(meter, 26.8437, 1000);
  // Upstrokes at 26.84, 53.69, ..., 993.22: the one at t = 0 has nothing before it.
  EXPECT_EQ(meter.period().n, 36);
  EXPECT_NEAR(meter.period().mean, 26.8437, 1e-6);
  EXPECT_LT(meter.period().sd, 1e-5);
}

TEST(PeriodMeter, CountsIntervalsWhoseEarlierUpstrokeIsLateEnough) {
  PeriodMeter meter(1, 100);
  add_sine(meter, 30, 1000);  // upstrokes at 30, 60, ..., 990; from 120 on
  EXPECT_EQ(meter.period().n, 29);
  PeriodMeter late(1, 1000);
  add_sine(late, 30, 1000);
  EXPECT_EQ(late.period().n, 0);
}

// Straight lines between the points (t, V), one sample each unit of time.
void add_trace(PeriodMeter& meter, std::initializer_list<double> V) {
  double t = 0;
  for (const double v : V) meter.add(t++, std::array{v});
}

TEST(PeriodMeter, InterpolatesTheUpstroke) {
  PeriodMeter meter(1, 0);
  add_trace(meter, {0, 0.8, 0, 0.25, 0.75, 0});  // up at 0.625 and, 0.25 to 0.75, at 3.5
  EXPECT_EQ(meter.period().n, 1);
  EXPECT_DOUBLE_EQ(meter.period().mean, 3.5 - 0.625);
}

TEST(PeriodMeter, FiresAgainOnlyAfterRepolarisation) {
  PeriodMeter meter(1, 0);
  // down to 0.2 is not below it: the second crossing is a ripple of the first beat
  add_trace(meter, {0, 1, 0.2, 1, 0.3, 1, 0.1, 1});
  EXPECT_EQ(meter.period().n, 1);
  EXPECT_NEAR(meter.period().mean, (6 + 0.4 / 0.9) - 0.5, 1e-14);
}

TEST(PeriodMeter, AnExcitedStartIsNoUpstroke) {
  PeriodMeter meter(1, 0);
  add_trace(meter, {1, 0, 1, 0, 1});
  EXPECT_EQ(meter.period().n, 1);
  EXPECT_DOUBLE_EQ(meter.period().mean, 2);
  PeriodMeter raised(1, 0);
  add_trace(raised, {0.4, 1, 0, 1, 0, 1});  // never below 0.2 before the first crossing
  EXPECT_EQ(raised.period().n, 1);
}

TEST(PeriodMeter, ProbesAreTakenTogether) {
  PeriodMeter meter(2, 0);
  for (int n = 0; n < 200; ++n) {
    // periods 8 and 10, seen in whole units: half up, half down
    meter.add(n, std::array{n % 8 < 4 ? 0.0 : 1.0, n % 10 < 5 ? 0.0 : 1.0});
  }
  // 25 upstrokes of the first, 20 of the second
  EXPECT_EQ(meter.period().n, 24 + 19);
  EXPECT_NEAR(meter.period().mean, (24 * 8 + 19 * 10) / 43.0, 1e-12);
  PeriodMeter none(0, 0);
  none.add(0, {});
  EXPECT_EQ(none.period().n, 0);
}

}  // namespace
}  // namespace myowave::solver
