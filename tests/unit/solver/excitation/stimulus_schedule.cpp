#include "solver/excitation/stimulus_schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace myowave::solver {
namespace {

const GridSettings grid{11, 17, 0.6};
constexpr double dt = 0.02;

Stimulus pulses(double start, double period, double duration, std::int64_t count) {
  Stimulus s;
  s.start = start;
  s.period = period;
  s.duration = duration;
  s.count = count;
  s.amplitude = 0.5;
  return s;
}

std::vector<std::int64_t> steps_on(const Stimulus& s, std::int64_t steps, double step_length = dt) {
  StimulusSchedule schedule({s}, grid, step_length);
  std::vector<std::int64_t> on;
  for (std::int64_t n = 0; n < steps; ++n)
    if (!schedule.active(static_cast<double>(n) * step_length).empty()) on.push_back(n);
  return on;
}

// Pulse m is on in the `length` steps from start + m period steps.
void expect_pulses(const std::vector<std::int64_t>& on, std::int64_t start, std::int64_t period,
                   std::int64_t length, std::int64_t count) {
  ASSERT_EQ(on.size(), static_cast<std::size_t>(length * count));
  for (std::int64_t m = 0; m < count; ++m)
    for (std::int64_t n = 0; n < length; ++n) EXPECT_EQ(on[m * length + n], start + m * period + n);
}

TEST(StimulusSchedule, PulseLastsItsStepsWhateverTheRounding) {
  expect_pulses(steps_on(pulses(0, 0, 0.2, 1), 1000), 0, 0, 10, 1);
  expect_pulses(steps_on(pulses(1, 1.4, 0.2, 700), 50 + 700 * 70), 50, 70, 10, 700);
  expect_pulses(steps_on(pulses(0.3, 32.14, 0.2, 400), 15 + 400 * 1607), 15, 1607, 10, 400);
  expect_pulses(steps_on(pulses(0, 0.06, 0.02, -1), 30000), 0, 3, 1, 10000);
  expect_pulses(steps_on(pulses(0.7, 33.3, 1, 300), 300 * 3330 + 70, 0.01), 70, 3330, 100, 300);
}

TEST(StimulusSchedule, PeriodsThatAreNotMultiplesOfAStepDoNotDrift) {
  // Pulse m starts at the first step at or after m times 1.37.
  const auto on = steps_on(pulses(0, 1.37, 0.02, 1000), 70000);
  ASSERT_EQ(on.size(), 1000U);
  for (std::size_t m = 0; m < on.size(); ++m)
    EXPECT_EQ(on[m], static_cast<std::int64_t>(std::ceil(1.37 * static_cast<double>(m) / dt - 1e-6)));
}

TEST(StimulusSchedule, CountEndsIt) {
  expect_pulses(steps_on(pulses(2, 4, 1, 3), 2000), 100, 200, 50, 3);
  EXPECT_TRUE(steps_on(pulses(2, 4, 1, 0), 2000).empty());
  EXPECT_EQ(steps_on(pulses(2, 4, 1, -1), 2000).size(), 10U * 50);
}

TEST(StimulusSchedule, SeveralAreOnTogetherInTheirOrder) {
  Stimulus second = pulses(1, 0, 2, 1);
  second.amplitude = -0.25;
  second.shape = Stimulus::Shape::block;
  second.columns = {2, 4};
  second.rows = {5, 5};
  StimulusSchedule schedule({pulses(0, 0, 2, 1), second}, grid, dt);
  EXPECT_EQ(schedule.active(0.5).size(), 1U);
  EXPECT_EQ(schedule.active(2.5).size(), 1U);
  EXPECT_TRUE(schedule.active(3).empty());
  const auto& both = schedule.active(1.5);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].amplitude, 0.5);
  EXPECT_EQ(both[1].amplitude, -0.25);
  EXPECT_TRUE(both[0].region.contains(0, 0));
  EXPECT_TRUE(both[0].region.contains(10, 16));
  EXPECT_TRUE(both[1].region.contains(5, 4));
  EXPECT_FALSE(both[1].region.contains(5, 5));
  EXPECT_FALSE(both[1].region.contains(4, 4));
}

TEST(StimulusSchedule, MoreToComeUntilTheLastPulseHasEnded) {
  const StimulusSchedule schedule({pulses(2, 4, 1, 3)}, grid, dt);
  EXPECT_TRUE(schedule.more_to_come(0));
  EXPECT_TRUE(schedule.more_to_come(8));
  EXPECT_TRUE(schedule.more_to_come(10.9));
  EXPECT_FALSE(schedule.more_to_come(11));
  EXPECT_TRUE(StimulusSchedule({pulses(2, 4, 1, -1)}, grid, dt).more_to_come(1e6));
  EXPECT_FALSE(StimulusSchedule({pulses(2, 4, 1, 0)}, grid, dt).more_to_come(0));
  EXPECT_FALSE(StimulusSchedule({}, grid, dt).more_to_come(0));
  Stimulus nothing = pulses(2, 4, 1, 3);
  nothing.amplitude = 0;
  EXPECT_FALSE(StimulusSchedule({nothing}, grid, dt).more_to_come(0));
}

TEST(StimulusSchedule, LastPeriodIsOfWhatEndsLast) {
  EXPECT_EQ(StimulusSchedule({}, grid, dt).last_period(), 0);
  EXPECT_EQ(StimulusSchedule({pulses(2, 0, 1, 1)}, grid, dt).last_period(), 0);
  EXPECT_EQ(StimulusSchedule({pulses(0, 40, 1, 10), pulses(400, 33, 1, 10)}, grid, dt).last_period(), 33);
  EXPECT_EQ(StimulusSchedule({pulses(0, 40, 1, -1), pulses(400, 33, 1, 10)}, grid, dt).last_period(), 40);
}

}  // namespace
}  // namespace myowave::solver
