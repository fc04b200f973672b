#include "solver/analysis/breakup.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace myowave::solver {
namespace {

constexpr double sample_every = 0.2;  // t.u.

// Samples every 0.2 t.u. until t_end, with tips(t) and V(t).
void watch(
    BreakupWatch& w, double t_end, const std::function<int(double)>& tips,
    const std::function<double(double)>& largest_V = [](double) { return 1.0; }, bool more_stimuli = false) {
  for (int n = 0; n * sample_every <= t_end; ++n) {
    const double t = n * sample_every;
    w.add_sample(t, tips(t + 1e-9), largest_V(t + 1e-9), more_stimuli);
  }
}

TEST(BreakupWatch, OneSpiralHasNoBreakupAndNoDeath) {
  BreakupWatch w(0);
  watch(w, 100, [](double) { return 1; });
  EXPECT_FALSE(w.breakup());
  EXPECT_FALSE(w.death());
}

TEST(BreakupWatch, BreakupIsTheFirstTimeOfALastingExcess) {
  BreakupWatch w(0);
  watch(w, 60, [](double t) { return t < 30 ? 1 : 3; });
  ASSERT_TRUE(w.breakup());
  EXPECT_NEAR(*w.breakup(), 30, 1e-9);
}

TEST(BreakupWatch, ExcessMustLast) {
  const auto after_excess = [](double duration) {
    BreakupWatch w(0);
    watch(w, 60, [=](double t) { return t >= 30 && t < 30 + duration ? 3 : 1; });
    return w.breakup();
  };
  EXPECT_FALSE(after_excess(0.2));
  EXPECT_FALSE(after_excess(2.0));  // the samples at 30.0 to 31.8
  ASSERT_TRUE(after_excess(2.2));
  EXPECT_NEAR(*after_excess(2.2), 30, 1e-9);
}

TEST(BreakupWatch, AnInterruptedExcessStartsAnew) {
  BreakupWatch w(0);
  watch(w, 60, [](double t) { return t >= 30 && !(t >= 31.6 && t < 31.8) ? 2 : 1; });
  ASSERT_TRUE(w.breakup());
  EXPECT_NEAR(*w.breakup(), 31.8, 1e-9);
}

TEST(BreakupWatch, ExcessIsOverTheTipsOfTheStart) {
  BreakupWatch w(0);
  watch(w, 60, [](double t) { return t < 20 ? 4 : t < 40 ? 3 : 5; });
  ASSERT_TRUE(w.breakup());
  EXPECT_NEAR(*w.breakup(), 40, 1e-9);
  BreakupWatch from_none(0);
  watch(from_none, 60, [](double t) { return t < 20 ? 0 : t < 40 ? 1 : 2; });
  ASSERT_TRUE(from_none.breakup());
  EXPECT_NEAR(*from_none.breakup(), 40, 1e-9);
}

TEST(BreakupWatch, RawDataCountOnlyAfterSettling) {
  const auto tips = [](double t) { return t < 4.9 ? 300 : t < 50 ? 2 : 3; };
  BreakupWatch w(BreakupWatch::settling_time);
  watch(w, 100, tips);
  ASSERT_TRUE(w.breakup());
  EXPECT_NEAR(*w.breakup(), 50, 1e-9);
}

TEST(BreakupWatch, LaterExcessesDoNotReplaceTheFirst) {
  BreakupWatch w(0);
  watch(w, 100, [](double t) { return t >= 20 && t < 30 ? 2 : t > 40 ? 9 : 1; });
  EXPECT_NEAR(*w.breakup(), 20, 1e-9);
}

TEST(BreakupWatch, DeathIsTheFirstQuietTimeWithoutStimuliToCome) {
  const auto none = [](double) { return 0; };
  const auto V = [](double t) { return t < 70 ? 0.9 : 0.049; };
  BreakupWatch w(0);
  watch(w, 100, none, V);
  ASSERT_TRUE(w.death());
  EXPECT_NEAR(*w.death(), 70, 1e-9);
  EXPECT_FALSE(w.breakup());
  BreakupWatch paced(0);
  watch(paced, 100, none, V, true);
  EXPECT_FALSE(paced.death());
  BreakupWatch at_the_limit(0);
  watch(at_the_limit, 100, none, [](double) { return 0.05; });
  EXPECT_FALSE(at_the_limit.death());
}

}  // namespace
}  // namespace myowave::solver
