// Runs that leave out what rests, beside runs of the whole sheet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/run.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using test::RecordingSink;

// A front that starts at the left end of a strip.
solver::Scene strip(double t_end) {
  solver::Scene scene;
  scene.grid = {41, 261, 0.6};
  scene.time.t_end = t_end;
  scene.stimuli.push_back({.amplitude = 2, .shape = solver::Stimulus::Shape::block});
  scene.stimuli[0].columns = {0, 5};
  scene.stimuli[0].rows = {0, scene.grid.rows - 1};
  scene.output.probes = {{20, 4}, {20, 30}, {0, 259}};
  scene.output.probes_every = 0.1;
  return scene;
}

// A stimulus of nothing: with it every step is one of the whole sheet.
solver::Scene step_by_step(solver::Scene scene) {
  scene.stimuli.push_back({.duration = 2 * scene.time.t_end, .amplitude = 0});
  return scene;
}

TEST(Quiescent, WithoutAToleranceARunHasTheBitsOfTheWholeSheet) {
  for (const auto precision : {solver::Precision::float64, solver::Precision::float32})
    for (const bool deforms : {false, true}) {
      solver::Scene scene = strip(12);
      scene.precision = precision;
      if (deforms) scene.mechanics.emplace().interval = 40;
      const test::RecordedRun part = test::recorded_run(scene),
                              whole = test::recorded_run(step_by_step(scene));
      EXPECT_EQ(part.state.V, whole.state.V);
      EXPECT_EQ(part.state.r, whole.state.r);
      EXPECT_EQ(part.state.Ta, whole.state.Ta);
      EXPECT_EQ(part.sink.nodes, whole.sink.nodes);
      ASSERT_EQ(part.sink.probe_samples.size(), 121U);
      for (std::size_t n = 0; n < part.sink.probe_samples.size(); ++n)
        EXPECT_EQ(part.sink.probe_samples[n].values, whole.sink.probe_samples[n].values);
      EXPECT_GT(part.state.V[20 * 261 + 20], 0.9);  // on its way
    }
}

// What is cut off ahead of a front hardly reaches it, for the front is pushed from behind.
TEST(Quiescent, AToleranceChangesAFrontByLess) {
  const solver::Scene exact = strip(30);
  const auto V = test::recorded_run(exact).state.V;
  const auto error = [&](double tolerance) {
    solver::Scene scene = exact;
    scene.quiescent = tolerance;
    const auto other = test::recorded_run(scene).state.V;
    double largest = 0;
    for (std::size_t k = 0; k < V.size(); ++k) largest = std::max(largest, std::abs(other[k] - V[k]));
    return largest;
  };
  for (const double tolerance : {1e-12, 1e-6, 1e-3}) {
    EXPECT_LE(error(tolerance), 0.1 * tolerance);
    EXPECT_GT(error(tolerance), 0);
  }
}

}  // namespace
}  // namespace myowave
