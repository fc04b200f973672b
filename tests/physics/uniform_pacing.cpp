// Fig 2a of the paper: maximal shortening under uniform pacing at 33 t.u.
#include <gtest/gtest.h>

#include "solver/run/run.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

// 60 beats; the summary's shortening is that of the last ten.
solver::RunSummary pace(const std::string& law, double eps_below, double eps_above) {
  solver::Scene scene;
  scene.grid = {11, 11, 0.6};
  scene.time = {0.02, 60 * 33.0, 10};
  scene.tension = {law, 47.9, eps_below, eps_above, 0.05};
  scene.mechanics.emplace();
  scene.mechanics->cells_per_element = 5;
  scene.mechanics->interval = 10;
  solver::Stimulus stimulus;
  stimulus.period = 33;
  stimulus.duration = 1;
  stimulus.amplitude = 0.5;
  stimulus.count = -1;
  scene.stimuli = {stimulus};
  test::RecordingSink sink;
  solver::RunSummary summary;
  solver::run(scene, solver::make_initial_state(scene), sink, summary);
  return summary;
}

TEST(UniformPacing, ShorteningWithDelayedTension) {
  const auto summary = pace("delayed", 1, 0.1);
  EXPECT_NEAR(summary.observables.shortening->first, 0.250, 0.003);
}

TEST(UniformPacing, ShorteningWithTensionAsPrinted) {
  const auto summary = pace("printed", 1, 10);
  EXPECT_NEAR(summary.observables.shortening->first, 0.324, 0.004);
}

}  // namespace
}  // namespace myowave
