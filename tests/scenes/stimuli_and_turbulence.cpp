// The other shipped scenes, each with a physical number.
#include <algorithm>

#include "tests/support/scene_run.hpp"

namespace myowave {
namespace {

using test::SceneRun;

TEST(Scenes, ContractingTurbulence) {
  const SceneRun run("contracting_turbulence", {"--until", "100"});
  EXPECT_GT(run.number("tips", "mean"), 3);
  EXPECT_TRUE(run.observable("death_tu").is_null());
  EXPECT_EQ(run.summary.at("mechanics").at("solves"), 63);
}

// One wave a stimulus at 31 t.u., and the area change of the whole sheet that radial waves make
// (0.31 without feedback).
TEST(Scenes, PointStimulus) {
  const SceneRun run("point_stimulus");
  EXPECT_NEAR(run.number("period", "mean"), 31.0, 0.005);
  EXPECT_LT(run.number("period", "sd"), 0.1);
  EXPECT_EQ(run.number("tips", "mean"), 0);
  const auto area = run.csv("area.csv");
  double smallest = 1, largest = 0;
  for (std::size_t n = 0; n < area.at("t").size(); ++n) {
    if (area.at("t")[n] < 1000) continue;
    smallest = std::min(smallest, area.at("area")[n]);
    largest = std::max(largest, area.at("area")[n]);
  }
  EXPECT_NEAR(largest - smallest, 0.30, 0.02);
}

TEST(Scenes, UniformPacing) {
  const SceneRun run("uniform_pacing");
  EXPECT_NEAR(run.number("shortening", "max"), 0.250, 0.003);
  // 185 ms after the stimulus
  const double t = run.number("shortening", "t");
  EXPECT_NEAR(t - 33 * static_cast<int>(t / 33), 18.5, 0.5);
  EXPECT_NEAR(run.number("period", "mean"), 33, 1e-6);
}

TEST(Scenes, UniformPacingWithThePrintedLaw) {
  const SceneRun run("uniform_pacing", {"--set", "tension.law=printed"});
  EXPECT_NEAR(run.number("shortening", "max"), 0.324, 0.004);
}

TEST(Scenes, Quickstart) {
  const SceneRun run("quickstart");
  EXPECT_EQ(run.number("tips", "mean"), 1);
  EXPECT_NEAR(run.number("period", "mean"), 27.4, 0.5);
  EXPECT_LT(run.number("area", "min"), 0.7);
}

}  // namespace
}  // namespace myowave
