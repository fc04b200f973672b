// The shipped scenes of single spirals, each with a physical number.
#include <gmock/gmock.h>

#include <algorithm>

#include "apps/base/memory.hpp"
#include "tests/support/scene_run.hpp"

namespace myowave {
namespace {

using test::SceneRun;

TEST(Scenes, RigidSpiral) {
  const SceneRun run("rigid_spiral");
  EXPECT_NEAR(run.number("period", "mean"), 26.816, 0.001);
  EXPECT_NEAR(run.number("period", "sd"), 0.37, 0.005);
  EXPECT_EQ(run.number("tips", "mean"), 1);
  EXPECT_TRUE(run.observable("area").is_null());
  for (const auto& [space, bytes] : run.summary.at("memory").at("most_bytes").items())
    EXPECT_THAT(run.output, testing::ContainsRegex("  memory .*" + apps::bytes_text(bytes) + " in " + space +
                                                   " \\([0-9.]+ [KM]iB estimated\\)"));
}

// Contraction keeps one spiral where the rigid sheet breaks it up, and lengthens its period (found:
// 27.7 +- 1.6 t.u. over a long run, against 26.5 of the rigid state that it starts from).
TEST(Scenes, ContractingSpiral) {
  const SceneRun run("contracting_spiral", {"--until", "300"});
  EXPECT_EQ(run.number("tips", "mean"), 1);
  EXPECT_TRUE(run.observable("breakup_tu").is_null());
  EXPECT_TRUE(run.observable("death_tu").is_null());
  EXPECT_NEAR(run.number("period", "mean"), 27.7, 1.0);
  EXPECT_NEAR(run.number("area", "max"), 0.7233, 0.001);
  EXPECT_NEAR(run.number("area", "min"), 0.673, 0.02);
  const auto& mechanics = run.summary.at("mechanics");
  EXPECT_EQ(mechanics.at("solves"), 188);
  EXPECT_GT(mechanics.at("min_J").get<double>(), 0.45);
  EXPECT_LE(mechanics.at("newton_max").get<int>(), 25);
}

// On 81 x 81 nodes a contracting spiral reaches the edge, within 330 to 669 t.u. over five starts; the
// rigid one stays where it is.
TEST(Scenes, DriftingSpiral) {
  const SceneRun run("drifting_spiral");
  constexpr double sheet = 80 * 0.6;
  const auto tips = run.csv("tips.csv");
  double reached = -1, closest = sheet;
  for (std::size_t n = 0; n < tips.at("t").size(); ++n) {
    const double x = tips.at("x")[n], y = tips.at("y")[n];
    const double to_edge = std::min({x, y, sheet - x, sheet - y});
    closest = std::min(closest, to_edge);
    if (reached < 0 && to_edge < 6) reached = tips.at("t")[n];
    if (tips.at("t")[n] < 100) {
      EXPECT_GT(to_edge, 15) << "t = " << tips.at("t")[n];
    }
  }
  EXPECT_GT(reached, 330);
  EXPECT_LT(reached, 669);
  EXPECT_LT(closest, 4);
  EXPECT_NEAR(run.number("period", "mean"), 28.46, 0.8);
}

TEST(Scenes, DriftingSpiralWithoutMechanicsStaysInTheMiddle) {
  const SceneRun run("drifting_spiral", {"--set", "mechanics.on=false"});
  const auto tips = run.csv("tips.csv");
  for (std::size_t n = 0; n < tips.at("t").size(); ++n) {
    ASSERT_NEAR(tips.at("x")[n], 24, 4) << "t = " << tips.at("t")[n];
    ASSERT_NEAR(tips.at("y")[n], 24, 4) << "t = " << tips.at("t")[n];
  }
  EXPECT_NEAR(run.number("period", "mean"), 26.84, 0.03);
  EXPECT_LT(run.number("period", "sd"), 0.4);
}

}  // namespace
}  // namespace myowave
