// Fig 2a of the paper: maximal shortening under uniform pacing at 33 t.u.
#include <gtest/gtest.h>

#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

// 60 beats; the summary's shortening is that of the last ten.
solver::RunSummary pace(solver::TensionLaw law) {
  solver::Scene scene;
  scene.grid = {11, 11, 0.6};
  scene.time = {0.02, 60 * 33.0, 10};
  scene.tension.law = law;
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
  const auto summary = pace(solver::TensionLaw::delayed);
  EXPECT_NEAR(summary.observables.shortening->first, 0.250, 0.003);
}

TEST(UniformPacing, ShorteningWithTensionAsPrinted) {
  const auto summary = pace(solver::TensionLaw::printed);
  EXPECT_NEAR(summary.observables.shortening->first, 0.324, 0.004);
}

}  // namespace
}  // namespace myowave
