// How many runs the memory holds at once.
#include "apps/base/memory.hpp"

#include <gtest/gtest.h>

#include "solver/run/make_plan.hpp"

namespace myowave::apps {
namespace {

TEST(Memory, HoldsAsManyRunsAsFitBesideEachOther) {
  const MemoryNeed need{.host = 100, .device = 40};
  EXPECT_EQ(runs_that_fit(8, need, 1000, 400), 8);
  EXPECT_EQ(runs_that_fit(8, need, 800, 320), 8);
  EXPECT_EQ(runs_that_fit(8, need, 799, 320), 7);
  EXPECT_EQ(runs_that_fit(8, need, 800, 159), 3) << "the device's bound is the lower one";
}

TEST(Memory, HoldsOneRunAtLeast) { EXPECT_EQ(runs_that_fit(8, {.host = 100, .device = 0}, 99, 0), 1); }

TEST(Memory, SetsNoLimitIfUnknownOrNotNeeded) {
  EXPECT_EQ(runs_that_fit(8, {.host = 100, .device = 40}, std::nullopt, std::nullopt), 8);
  EXPECT_EQ(runs_that_fit(8, {.host = 100, .device = 40}, std::nullopt, 120), 3);
  EXPECT_EQ(runs_that_fit(8, {}, 0, 0), 8);
}

// The start of `initial.dx` is 41 x 41 nodes of V, r and Ta, beside what the run has.
TEST(Memory, OfARunIsThatOfItsPlanAndItsStart) {
  solver::Scene scene;
  scene.grid = {81, 81, 0.6};
  const solver::Plan plan = solver::make_plan(scene);
  const MemoryNeed need = memory_need(scene);
  EXPECT_EQ(need.host + need.device, plan.bytes());
  EXPECT_EQ(need.device, solver::has_device_memory() ? plan.device_bytes() : 0);
  scene.initial.dx = 1.2;
  EXPECT_EQ(memory_need(scene).host, need.host + 3 * sizeof(double) * 41 * 41);
}

}  // namespace
}  // namespace myowave::apps
