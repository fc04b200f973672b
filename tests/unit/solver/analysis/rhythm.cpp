#include "solver/analysis/rhythm.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace myowave::solver {
namespace {

constexpr double dt = 0.02;

// V = 0.5 + 0.45 sin(2 pi t / period)
void add_sine(BeatRecorder& meter, double period, double t_end) {
  for (int n = 0; n * dt < t_end; ++n) {
    const double t = n * dt, V = 0.5 + 0.45 * std::sin(2 * std::numbers::pi * t / period);
    meter.add(t, std::array{V});
  }
}

TEST(BeatRecorder, FindsAKnownPeriodBetweenTheSteps) {
  BeatRecorder meter(1, 0);
  add_sine(meter, 26.8437, 1000);
  // Upstrokes at 26.84, 53.69, ..., 993.22: the one at t = 0 has nothing before it.
  EXPECT_EQ(meter.period().n, 36);
  EXPECT_NEAR(meter.period().mean, 26.8437, 1e-6);
  EXPECT_LT(meter.period().sd, 1e-5);
}

TEST(BeatRecorder, CountsIntervalsWhoseEarlierUpstrokeIsLateEnough) {
  BeatRecorder meter(1, 100);
  add_sine(meter, 30, 1000);  // upstrokes at 30, 60, ..., 990; from 120 on
  EXPECT_EQ(meter.period().n, 29);
  BeatRecorder late(1, 1000);
  add_sine(late, 30, 1000);
  EXPECT_EQ(late.period().n, 0);
}

// Straight lines between the points (t, V), one sample each unit of time.
void add_trace(BeatRecorder& meter, std::initializer_list<double> V) {
  double t = 0;
  for (const double v : V) meter.add(t++, std::array{v});
}

TEST(BeatRecorder, InterpolatesTheUpstroke) {
  BeatRecorder meter(1, 0);
  add_trace(meter, {0, 0.8, 0, 0.25, 0.75, 0});  // up at 0.625 and, 0.25 to 0.75, at 3.5
  EXPECT_EQ(meter.period().n, 1);
  EXPECT_DOUBLE_EQ(meter.period().mean, 3.5 - 0.625);
}

TEST(BeatRecorder, FiresAgainOnlyAfterRepolarisation) {
  BeatRecorder meter(1, 0);
  // down to 0.2 is not below it: the second crossing is a ripple of the first beat
  add_trace(meter, {0, 1, 0.2, 1, 0.3, 1, 0.1, 1});
  EXPECT_EQ(meter.period().n, 1);
  EXPECT_NEAR(meter.period().mean, (6 + 0.4 / 0.9) - 0.5, 1e-14);
}

TEST(BeatRecorder, AnExcitedStartIsNotAnUpstroke) {
  BeatRecorder meter(1, 0);
  add_trace(meter, {1, 0, 1, 0, 1});
  EXPECT_EQ(meter.period().n, 1);
  EXPECT_DOUBLE_EQ(meter.period().mean, 2);
  BeatRecorder raised(1, 0);
  add_trace(raised, {0.4, 1, 0, 1, 0, 1});  // never below 0.2 before the first crossing
  EXPECT_EQ(raised.period().n, 1);
}

TEST(BeatRecorder, ProbesAreTakenTogether) {
  BeatRecorder meter(2, 0);
  for (int n = 0; n < 200; ++n) {
    // periods 8 and 10, seen in whole units: half up, half down
    meter.add(n, std::array{n % 8 < 4 ? 0.0 : 1.0, n % 10 < 5 ? 0.0 : 1.0});
  }
  // 25 upstrokes of the first, 20 of the second
  EXPECT_EQ(meter.period().n, 24 + 19);
  EXPECT_NEAR(meter.period().mean, (24 * 8 + 19 * 10) / 43.0, 1e-12);
  BeatRecorder none(0, 0);
  none.add(0, {});
  EXPECT_EQ(none.period().n, 0);
}

// V = A sin(pi s / W) for s in (0, W) after each multiple of the period, else 0; W and A alternate.
struct SinePulses {
  double period;
  std::vector<double> width, amplitude;

  double V(double t) const {
    const auto n = static_cast<std::size_t>(t / period);
    const double s = t - static_cast<double>(n) * period, W = width[n % width.size()];
    return s < W ? amplitude[n % amplitude.size()] * std::sin(std::numbers::pi * s / W) : 0;
  }
  // Time from the start of pulse n until V rises, or falls, through `level`.
  double rise(std::size_t n, double level) const {
    return width[n % width.size()] * std::asin(level / amplitude[n % amplitude.size()]) / std::numbers::pi;
  }
  double fall(std::size_t n, double level) const { return width[n % width.size()] - rise(n, level); }
};

// Of the only probe.
std::vector<Beat> finished(BeatRecorder& recorder) {
  recorder.finish();
  std::vector<Beat> beats;
  for (const auto& [probe, beat] : recorder.take()) beats.push_back(beat);
  return beats;
}

std::vector<Beat> beats_of(const SinePulses& pulses, double t_end) {
  BeatRecorder recorder(1, 0);
  for (int n = 0; n * dt < t_end; ++n) recorder.add(n * dt, std::array{pulses.V(n * dt)});
  return finished(recorder);
}

TEST(BeatRecorder, MeasuresTheDurationsOfKnownPulses) {
  const SinePulses pulses{40.01, {30, 17, 22}, {1, 0.9, 0.7}};
  const auto beats = beats_of(pulses, 10 * 40.01);
  ASSERT_EQ(beats.size(), 10);
  constexpr double error = 2e-5;  // of lines between samples: V'' dt^2 / 8 over the slope
  for (std::size_t n = 0; n < 10; ++n) {
    const double tenth = 0.1 * pulses.amplitude[n % 3];
    EXPECT_NEAR(beats[n].upstroke, 40.01 * static_cast<double>(n) + pulses.rise(n, 0.5), error);
    EXPECT_NEAR(beats[n].apd, pulses.fall(n, 0.1) - pulses.rise(n, 0.1), error);
    EXPECT_NEAR(beats[n].apd90, pulses.fall(n, tenth) - pulses.rise(n, 0.5), error);
    if (n == 9) break;
    EXPECT_NEAR(beats[n].period, 40.01 + pulses.rise(n + 1, 0.5) - pulses.rise(n, 0.5), error);
    EXPECT_DOUBLE_EQ(beats[n].di, beats[n].period - beats[n].apd90);
  }
  EXPECT_TRUE(std::isnan(beats[9].period)) << "nothing comes after it";
  EXPECT_TRUE(std::isnan(beats[9].di));
}

TEST(BeatRecorder, MeansAndSpreadOfAlternans) {
  const SinePulses alternans{35, {28, 20}, {1}};
  BeatRecorder recorder(1, 70);  // from the third pulse on
  for (int n = 0; n * dt < 12 * 35.0; ++n) recorder.add(n * dt, std::array{alternans.V(n * dt)});
  recorder.finish();
  const double portion = 1 - 2 * std::asin(0.1) / std::numbers::pi;
  EXPECT_EQ(recorder.apd().n, 10);
  EXPECT_NEAR(recorder.apd().mean, 24 * portion, 1e-4);
  EXPECT_NEAR(recorder.apd().sd, 4 * portion * std::sqrt(10.0 / 9), 1e-4);
  EXPECT_EQ(recorder.apd90().n, 10);
  EXPECT_NEAR(recorder.apd90().mean, 24 * (1 - (std::asin(0.1) + std::asin(0.5)) / std::numbers::pi), 1e-4);
  EXPECT_EQ(recorder.period().n, 9);
}

// V at rest need not be 0: the amplitude is of the beat itself, V > 0.1 is not.
TEST(BeatRecorder, AmplitudeIsFromTheLowestVoltageBefore) {
  BeatRecorder recorder(1, 0);
  add_trace(recorder, {0.15, 0.15, 1.15, 0.15, 0.15, 1.15, 0.05, 1});
  const auto beats = finished(recorder);
  ASSERT_EQ(beats.size(), 3);
  EXPECT_NEAR(beats[0].upstroke, 1.35, 1e-14);
  EXPECT_NEAR(beats[0].apd90, 2.9 - 1.35, 1e-14) << "to 0.15 + 0.1";
  EXPECT_TRUE(std::isnan(beats[0].apd)) << "V has not been below 0.1";
  EXPECT_NEAR(beats[1].apd90, 5 + 0.9 / 1.1 - 4.35, 1e-14);
  EXPECT_TRUE(std::isnan(beats[1].apd)) << "nor before the second";
  EXPECT_TRUE(std::isnan(beats[2].apd)) << "which has not ended";
}

TEST(BeatRecorder, EachBeatNamesItsProbe) {
  BeatRecorder recorder(2, 0);
  double t = 0;
  for (const double V : {0.0, 1.0, 0.0, 1.0}) recorder.add(t++, std::array{0.0, V});
  const auto complete = recorder.take();
  ASSERT_EQ(complete.size(), 1);
  EXPECT_EQ(complete[0].probe, 1);
  EXPECT_EQ(complete[0].beat.period, 2);
  EXPECT_TRUE(recorder.take().empty()) << "each is taken once";
  recorder.finish();
  const auto last = recorder.take();
  ASSERT_EQ(last.size(), 1);
  EXPECT_EQ(last[0].beat.upstroke, 2.5);
}

}  // namespace
}  // namespace myowave::solver
