#include "solver/analysis/tip_trajectory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "kernels/observe/phase_singularity.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave::solver {
namespace {

constexpr double sample_every = 0.2;  // t.u.
constexpr double two_pi = 2 * std::numbers::pi;

// 101 x 101 nodes, 60 x 60 length units.
Scene sheet() {
  Scene scene;
  scene.grid = {101, 101, 0.6};
  return scene;
}

using TipsAt = std::function<std::vector<Tip>(double)>;

// All trajectories by their number.
std::vector<TipTrajectory> follow(double t_end, const TipsAt& tips) {
  const Scene scene = sheet();
  TipTrajectories trajectories(scene);
  for (int n = 0; n * sample_every <= t_end + 1e-9; ++n) {
    auto now = tips(n * sample_every);
    trajectories.add_sample(n * sample_every, now);
    for (const auto& tip : now) EXPECT_GE(tip.trajectory, 0);
  }
  trajectories.finish();
  auto ended = trajectories.take_ended();
  std::ranges::sort(ended, {}, &TipTrajectory::number);
  EXPECT_EQ(static_cast<std::int64_t>(ended.size()), trajectories.counts().n);
  return ended;
}

// A tip on a circle of radius 1.8 about (x, y), period 26.8 t.u.
constexpr double radius = 1.8, period = 26.8;
Tip on_circle(double x, double y, double t, int charge = 1) {
  const double phase = charge * two_pi * t / period;
  return {x + radius * std::cos(phase), y + radius * std::sin(phase), charge};
}

TEST(TipTrajectory, OfACircleHasItsCenterAndRadius) {
  for (const int charge : {1, -1}) {
    const auto all =
        follow(10.5 * period, [&](double t) { return std::vector{on_circle(30.2, 24.7, t, charge)}; });
    ASSERT_EQ(all.size(), 1U);
    const auto& one = all[0];
    EXPECT_EQ(one.number, 0);
    EXPECT_EQ(one.charge, charge);
    EXPECT_EQ(one.birth, 0);
    EXPECT_NEAR(one.death, 10.5 * period, sample_every);
    EXPECT_EQ(one.born, TipEvent::run);
    EXPECT_EQ(one.ended, TipEvent::run);
    EXPECT_FALSE(one.boundary);
    ASSERT_TRUE(one.core);
    EXPECT_EQ(one.core->rotations, 10);
    EXPECT_NEAR(one.core->x, 30.2, 0.01);
    EXPECT_NEAR(one.core->y, 24.7, 0.01);
    EXPECT_NEAR(one.core->radius, radius, 0.002);
    ASSERT_TRUE(one.drift);
    EXPECT_LT(one.drift->speed, 1e-4);
  }
}

TEST(TipTrajectory, NeedsAWholeRotationForACoreAndTwoForADrift) {
  const auto after = [](double rotations) {
    return follow(rotations * period, [](double t) { return std::vector{on_circle(30, 30, t)}; })[0];
  };
  EXPECT_FALSE(after(0.95).core);
  EXPECT_TRUE(after(1.2).core);
  EXPECT_FALSE(after(1.9).drift);
  EXPECT_TRUE(after(2.2).drift);
}

// A tip that waits or moves straight has no core.
TEST(TipTrajectory, WithoutARotationHasNoCore) {
  EXPECT_FALSE(follow(100, [](double) { return std::vector{Tip{30, 30, 1}}; })[0].core);
  EXPECT_FALSE(follow(100, [](double t) { return std::vector{Tip{10 + 0.4 * t, 30, 1}}; })[0].core);
}

TEST(TipTrajectory, OfADriftingCoreHasItsVelocity) {
  const double vx = 0.05, vy = -0.03;
  const auto all = follow(300, [&](double t) { return std::vector{on_circle(20 + vx * t, 40 + vy * t, t)}; });
  ASSERT_EQ(all.size(), 1U);
  ASSERT_TRUE(all[0].drift && all[0].core);
  EXPECT_NEAR(all[0].drift->speed, std::hypot(vx, vy), 0.005 * std::hypot(vx, vy));
  EXPECT_NEAR(all[0].drift->direction, std::atan2(vy, vx), 0.005);
  // It moves by 1.6 in a rotation, which lengthens the mean distance from the rotation's mean by up to a
  // tenth.
  EXPECT_GT(all[0].core->radius, radius);
  EXPECT_LT(all[0].core->radius, 1.12 * radius);
  EXPECT_NEAR(all[0].core->rotations, 300 / period, 1);
}

TEST(TipTrajectory, TheDriftIsThatOfTheLeastSquares) {
  // Cores at 0, 1, 5 at equal times: slope 2.5 a rotation.
  const auto x = [](double t) { return 30 + (t < period ? 0 : t < 2 * period ? 1 : 5); };
  RotationMeter meter(0.6);
  for (double t = 0; t < 3.2 * period; t += 0.05) {
    const Tip tip = on_circle(x(t - 0.7), 30, t);
    meter.add(t, tip.x, tip.y);
  }
  ASSERT_EQ(meter.core()->rotations, 3);
  EXPECT_NEAR(meter.drift()->speed, 2.5 / period, 0.1 / period);
}

TEST(TipTrajectory, TwoThatMeetEndAsAPair) {
  // Relative speed 1.2; they vanish when 0.4 apart.
  const auto all = follow(40, [](double t) {
    const double apart = 36.1 - 1.2 * t;
    if (apart < 0.4) return std::vector<Tip>{};
    return std::vector<Tip>{{30 - apart / 2, 30, 1}, {30 + apart / 2, 31, -1}};
  });
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].charge, -all[1].charge);
  for (const auto& one : all) {
    EXPECT_EQ(one.born, TipEvent::run);
    EXPECT_EQ(one.ended, TipEvent::pair);
    EXPECT_NEAR(one.death, 29.6, 0.2);
  }
}

TEST(TipTrajectory, OneThatLeavesEndsAtTheBoundary) {
  const auto all = follow(100, [](double t) {
    const double x = 40 + 0.5 * t;
    return x > 60 ? std::vector<Tip>{} : std::vector<Tip>{{x, 30, -1}};
  });
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].ended, TipEvent::boundary);
  EXPECT_NEAR(all[0].death, 40, 1e-9);
  ASSERT_TRUE(all[0].boundary);
  EXPECT_NEAR(*all[0].boundary, 28, 1e-9);  // ten nodes, 6 length units, from the edge
}

TEST(TipTrajectory, OneThatVanishesInTheMiddleEndsAlone) {
  const auto all = follow(50, [](double t) {
    return t > 20 ? std::vector<Tip>{} : std::vector<Tip>{{30, 30, 1}};
  });
  EXPECT_EQ(all[0].ended, TipEvent::alone);
  EXPECT_FALSE(all[0].boundary);
}

// Two tips of the same charge are not a pair, and tips of opposite charge are not linked.
TEST(TipTrajectory, ChargeIsConstant) {
  const auto all = follow(30, [](double t) {
    const int charge = t < 10 ? 1 : -1;
    return std::vector<Tip>{{30, 30, charge}, {31, 30, charge}};
  });
  ASSERT_EQ(all.size(), 4U);
  for (const auto& one : all) EXPECT_TRUE(one.ended == TipEvent::alone || one.born == TipEvent::alone);
}

TEST(TipTrajectory, BirthsInPairsAndAtTheBoundaryAreDistinguished) {
  const auto all = follow(40, [](double t) {
    std::vector<Tip> tips{on_circle(15, 15, t)};
    if (t > 10) {
      tips.push_back({40 + 0.3 * (t - 10), 40, 1});
      tips.push_back({40 - 0.3 * (t - 10), 40, -1});
    }
    if (t > 20) tips.push_back({30, 0.3 * (t - 20), -1});
    return tips;
  });
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].born, TipEvent::run);
  EXPECT_EQ(all[1].born, TipEvent::pair);
  EXPECT_EQ(all[2].born, TipEvent::pair);
  EXPECT_EQ(all[1].charge, -1);  // numbered by row, then column
  EXPECT_EQ(all[3].born, TipEvent::boundary);
  EXPECT_NEAR(all[1].birth, 10.2, 1e-9);
  for (const auto& one : all) EXPECT_EQ(one.ended, TipEvent::run);
}

// A jump farther than a tip can move is another tip.
TEST(TipTrajectory, TheGateFollowsTheIntervalAndTheFastestFront) {
  Scene scene;
  // sqrt(k D / 2) = 2 length units a t.u., front width sqrt(8 D / k) = 1
  EXPECT_DOUBLE_EQ(gating_distance(scene, 0.2), 0.8 + 2.5);
  EXPECT_DOUBLE_EQ(gating_distance(scene, 4), 16 + 2.5);
  scene.excitation.C_m = 2;
  EXPECT_DOUBLE_EQ(gating_distance(scene, 4), 8 + 2.5);
  scene.excitation.k = 0;
  EXPECT_DOUBLE_EQ(gating_distance(scene, 4), 4 * 0.6);
  const auto jump_of = [](double d) {
    return follow(20, [=](double t) { return std::vector<Tip>{{t < 10 ? 30 : 30 + d, 30, 1}}; }).size();
  };
  EXPECT_EQ(jump_of(3.2), 1U);
  EXPECT_EQ(jump_of(3.4), 2U);
}

// Many tips, each on its own circle: the order of the tips changes no result, numbers included.
TEST(TipTrajectory, TheOrderOfTheTipsDoesNotMatter) {
  std::mt19937 bits(5);
  const auto tips_at = [](double t) {
    std::vector<Tip> tips;
    for (int n = 0; n < 40; ++n)
      if (t > n && t < 60 - n / 2)
        tips.push_back(on_circle(4 + 7.3 * (n % 8), 5 + 11.1 * (n / 8), t + n, n % 2 ? 1 : -1));
    return tips;
  };
  const auto straight = follow(60, tips_at);
  const auto shuffled = follow(60, [&](double t) {
    auto tips = tips_at(t);
    std::ranges::shuffle(tips, bits);
    return tips;
  });
  ASSERT_EQ(straight.size(), shuffled.size());
  EXPECT_GE(straight.size(), 40U);
  for (std::size_t n = 0; n < straight.size(); ++n) {
    const auto& [a, b] = std::pair{straight[n], shuffled[n]};
    EXPECT_EQ(a.charge, b.charge);
    EXPECT_EQ(a.birth, b.birth);
    EXPECT_EQ(a.death, b.death);
    EXPECT_EQ(a.born, b.born);
    EXPECT_EQ(a.ended, b.ended);
    ASSERT_EQ(a.core.has_value(), b.core.has_value());
    if (a.core) {
      EXPECT_EQ(a.core->x, b.core->x);
      EXPECT_EQ(a.core->radius, b.core->radius);
    }
  }
}

struct FieldRate {
  EnsembleField<double, test::MemorySpace> values;
  KOKKOS_FUNCTION double operator()(int m, int i, int j) const { return values(m, i, j); }
};

// A field that rotates about a point on a circle, through the search on the device: position, charge, core.
TEST(TipTrajectory, OfARotatingFieldIsItsCenters) {
  const tissue::Grid grid{101, 101, 0.6};
  const auto tips = [&](double t) {
    const Tip center = on_circle(33.3, 21.9, t);
    test::Values V, rate;
    for (int i = 0; i < grid.rows; ++i)
      for (int j = 0; j < grid.columns; ++j) {
        const std::complex<double> z{j * grid.dx - center.x, i * grid.dx - center.y};
        const auto field = 0.5 * std::tanh(std::abs(z)) * std::polar(1.0, std::arg(z) - two_pi * t / period);
        V.push_back(0.5 + field.real());
        rate.push_back(field.imag());
      }
    const Kokkos::View<int, test::MemorySpace> count("count");
    const Kokkos::View<observe::PhaseSingularity*, test::MemorySpace> list("tips", 16);
    observe::find_phase_singularities(test::ExecutionSpace(), grid, test::to_view<double>(101, 101, {V}),
                                      FieldRate{test::to_view<double>(101, 101, {rate})}, count, list);
    int found = 0;
    Kokkos::deep_copy(found, count);
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, list);
    EXPECT_EQ(found, 1);
    EXPECT_NEAR(host(0).x, center.x, 0.1);
    EXPECT_NEAR(host(0).y, center.y, 0.1);
    return std::vector<Tip>{{host(0).x, host(0).y, host(0).charge}};
  };
  const auto all = follow(3.2 * period, tips);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].charge, 1);
  ASSERT_TRUE(all[0].core && all[0].drift);
  EXPECT_EQ(all[0].core->rotations, 3);
  EXPECT_NEAR(all[0].core->x, 33.3, 0.02);
  EXPECT_NEAR(all[0].core->y, 21.9, 0.02);
  EXPECT_NEAR(all[0].core->radius, radius, 0.02);
  EXPECT_LT(all[0].drift->speed, 1e-3);
}

// A broken front: one tip from the start; all others appear and vanish in pairs.
TEST(TipTrajectory, OfABrokenFrontThatCurls) {
  Scene scene = sheet();
  scene.time.t_end = 100;
  scene.initial.type = InitialSettings::Type::broken_front;
  scene.initial.offset = {0, 25};
  scene.output.tips_every = sample_every;
  const auto run = test::recorded_run(scene);
  const auto& found = run.sink.trajectories;
  EXPECT_EQ(found.size(), static_cast<std::size_t>(run.summary.observables.trajectories.n));
  const auto main = std::ranges::find(found, 0, &TipTrajectory::number);
  ASSERT_NE(main, found.end());
  EXPECT_EQ(main->born, TipEvent::run);
  EXPECT_EQ(main->ended, TipEvent::run);
  EXPECT_EQ(main->death, 100);
  for (const auto& one : found)
    if (one.number != 0) {
      EXPECT_EQ(one.born, TipEvent::pair) << one.number;
      EXPECT_EQ(one.ended, TipEvent::pair) << one.number;
    }
  // Each sample has every trajectory alive at that time exactly once.
  for (const auto& sample : run.sink.tip_samples) {
    std::vector<int> numbers, living;
    for (const auto& tip : sample.tips) numbers.push_back(tip.trajectory);
    if (sample.t < 5 - 1e-9) {  // step data: not linked yet
      EXPECT_TRUE(std::ranges::all_of(numbers, [](int number) { return number == -1; }));
      continue;
    }
    for (const auto& one : found)
      if (one.birth <= sample.t && sample.t <= one.death) living.push_back(one.number);
    std::ranges::sort(numbers);
    std::ranges::sort(living);
    EXPECT_EQ(numbers, living) << sample.t;
  }
}

}  // namespace
}  // namespace myowave::solver
