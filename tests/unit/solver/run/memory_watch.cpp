#include "solver/run/memory_watch.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <optional>

#include "solver/base/error.hpp"
#include "solver/run/device_memory.hpp"
#include "solver/run/make_plan.hpp"

namespace myowave::solver {
namespace {

using View = Kokkos::View<double*, Kokkos::HostSpace>;

int heard_by_tool = 0;

TEST(MemoryWatch, ReportsTheLargestTotalOfTheProjectsViews) {
  const View before("myowave::test::before", 1000);
  std::optional<View> older;
  older.emplace("myowave::test::older", 50);
  const MemoryWatch watch;
  EXPECT_TRUE(watch.most().empty());
  older.reset();  // allocated before the watch
  {
    const View a("myowave::test::a", 100);
    const View foreign("somebody::else", 5000);
    { const View b("myowave::test::b", 20); }
    const View c("myowave::test::c", 10);
  }
  const View last("myowave::test::last", 30);
  const auto most = watch.most();
  ASSERT_EQ(most.size(), 1U);
  EXPECT_EQ(most[0].space, Kokkos::HostSpace::name());
  EXPECT_EQ(most[0].bytes, 120 * sizeof(double));
}

TEST(MemoryWatch, ALoadedToolStillGetsAllEvents) {
  namespace tools = Kokkos::Tools::Experimental;
  const auto before = tools::get_callbacks();
  tools::set_allocate_data_callback(
      [](Kokkos::Tools::SpaceHandle, const char*, const void*, std::uint64_t) { ++heard_by_tool; });
  {
    const MemoryWatch watch;
    const View a("myowave::test::a", 100), b("somebody::else", 5);
    EXPECT_EQ(heard_by_tool, 2);
    EXPECT_EQ(watch.most().front().bytes, 100 * sizeof(double));
  }
  const View later("myowave::test::later", 1);
  EXPECT_EQ(heard_by_tool, 3) << "the callbacks set before the watch";
  tools::set_callbacks(before);
}

TEST(DeviceMemory, ASceneThatDoesNotFitIsRefused) {
  Scene scene;
  scene.name = "large";
  scene.grid = {1001, 1001, 0.6};
  const std::uint64_t needed = make_plan(scene).device_bytes();
  EXPECT_NO_THROW(require_device_memory(scene, needed));
  EXPECT_NO_THROW(require_device_memory(scene, std::nullopt));
  try {
    require_device_memory(scene, needed - 1);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "scene \"large\" (1001 x 1001 nodes) needs 45.9 MiB of the device's memory and 45.9 MiB are free; "
        "take a smaller grid.n, accuracy.precision = \"float32\", or a device with more memory");
  }
  EXPECT_EQ(free_device_memory().has_value(), has_device_memory());
}

TEST(DeviceMemory, IsWhatTheExcitationNeedsBesideTheHosts) {
  Scene scene;
  scene.grid = {251, 251, 0.6};
  scene.mechanics.emplace();
  const Plan plan = make_plan(scene);
  std::uint64_t views = 0;
  for (const auto& [space, bytes] : views_of(plan)) views += bytes;
  EXPECT_LT(plan.device_bytes(), views);
  EXPECT_GT(plan.device_bytes(), 251 * 251 * 6 * sizeof(double));  // V, r and Ta, old and new
  EXPECT_EQ(views_of(plan).size(), has_device_memory() ? 2U : 1U);
}

}  // namespace
}  // namespace myowave::solver
