#include "tests/support/reference_coupled.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/allclose.hpp"

namespace myowave::reference {
namespace {

using testing_support::all_close;

solver::Scene sheet() {
  solver::Scene scene;
  scene.grid = {9, 13, 0.6};
  scene.mechanics.emplace();
  scene.mechanics->cells_per_element = 4;
  scene.mechanics->interval = 20;
  scene.mechanics->tolerance = 1e-12;
  return scene;
}

ExcitationState uniform(const solver::Scene& scene, double V, double r, double Ta) {
  const std::size_t size = static_cast<std::size_t>(scene.grid.rows) * scene.grid.columns;
  return {Values(size, V), Values(size, r), Values(size, Ta)};
}

// Of a uniformly stretched sheet, from its first two nodes.
double stretch(const solver::Scene& scene, const CoupledState& state) {
  return (state.nodes[2] - state.nodes[0]) / (scene.mechanics->cells_per_element * scene.grid.dx);
}

TEST(ReferenceCoupled, NodesAreThoseOfTheLastSolve) {
  const solver::Scene scene = sheet();
  const auto initial = uniform(scene, 0, 0, 10);
  const auto lambda = [&](int steps) { return stretch(scene, run(scene, initial, steps)); };
  // At rest Ta decays by 1 - dt a step: the solves at steps 0, 20 and 40 see Ta of those steps.
  EXPECT_NEAR(lambda(0), 1, 1e-11);
  EXPECT_NEAR(lambda(19), 1, 1e-11);
  EXPECT_NEAR(lambda(20), equibiaxial_stretch(*scene.mechanics, 10 * std::pow(0.98, 20)), 1e-11);
  EXPECT_NEAR(lambda(39), equibiaxial_stretch(*scene.mechanics, 10 * std::pow(0.98, 20)), 1e-11);
  EXPECT_NEAR(lambda(40), equibiaxial_stretch(*scene.mechanics, 10 * std::pow(0.98, 40)), 1e-11);
}

TEST(ReferenceCoupled, WithoutContractionTheSheetStaysAtItsRest) {
  solver::Scene scene = sheet();
  scene.mechanics->contraction = false;
  EXPECT_NEAR(stretch(scene, run(scene, uniform(scene, 0.5, 0.5, 30), 40)), 1.1293425101, 1e-10);
}

TEST(ReferenceCoupled, RigidRunHasNoNodes) {
  solver::Scene scene = sheet();
  scene.mechanics.reset();
  EXPECT_TRUE(run(scene, uniform(scene, 0.5, 0.5, 30), 3).nodes.empty());
}

TEST(ReferenceCoupled, StimulusActsInItsTimeAndPlace) {
  solver::Scene scene = sheet();
  solver::Stimulus pulse;
  pulse.start = 2;
  pulse.period = 10;
  pulse.duration = 1;
  pulse.count = 2;
  pulse.amplitude = 0.5;
  pulse.shape = solver::Stimulus::Shape::block;
  pulse.columns = {1, 2};
  pulse.rows = {3, 3};
  solver::Stimulus disc;
  disc.amplitude = 0.25;
  disc.duration = 3;
  disc.shape = solver::Stimulus::Shape::disc;
  disc.center = {2, 3};
  disc.radius = 1;
  scene.stimuli = {pulse, disc};
  const Grid grid{9, 13, 0.6};
  const auto at = [&](double t, int i, int j) { return stimulus(scene, t)[grid.node(i, j)]; };
  EXPECT_EQ(at(2.5, 3, 1), 0.75);
  EXPECT_EQ(at(2.5, 4, 2), 0.25);
  EXPECT_EQ(at(2.5, 4, 3), 0);
  EXPECT_EQ(at(1.99, 3, 1), 0.25);
  EXPECT_EQ(at(3, 3, 1), 0);
  EXPECT_EQ(at(12, 3, 1), 0.5);
  EXPECT_EQ(at(22, 3, 1), 0);
}

TEST(ReferenceCoupled, PulseLastsItsNumberOfSteps) {
  solver::Scene scene = sheet();
  solver::Stimulus pulse;
  pulse.start = 1;
  pulse.period = 1.4;
  pulse.duration = 0.2;
  pulse.count = 7;
  pulse.amplitude = 1;
  scene.stimuli = {pulse};
  int steps_on = 0;
  for (int step = 0; step < 1000; ++step) steps_on += stimulus(scene, step * 0.02)[0] > 0 ? 1 : 0;
  EXPECT_EQ(steps_on, 7 * 10);
}

TEST(ReferenceCoupled, StretchSlowsTheWaveInMaterialCoordinates) {
  solver::Scene scene = sheet();
  scene.mechanics->contraction = false;
  ExcitationState front = uniform(scene, 0, 0, 0);
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 3; ++j) front.V[13 * i + j] = 1;
  const auto excited = [&](solver::MetricForm metric) {
    scene.metric = metric;
    double sum = 0;
    for (const double V : run(scene, front, 100).fields.V) sum += V;
    return sum;
  };
  const double stretched = excited(solver::MetricForm::conservative);
  EXPECT_LT(stretched, excited(solver::MetricForm::none));
  // Uniform stretch: both forms are the five-point stencil over lambda^2.
  EXPECT_NEAR(stretched, excited(solver::MetricForm::expanded), 1e-10);
}

}  // namespace
}  // namespace myowave::reference
