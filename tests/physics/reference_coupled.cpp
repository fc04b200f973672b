// The product against the plain serial reference, step by step, on a sheet that a broken wave front deforms.
#include "tests/support/reference_coupled.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "solver/run/run.hpp"
#include "tests/support/allclose.hpp"

namespace myowave {
namespace {

using solver::MetricForm;
using solver::MetricTime;
using testing_support::all_close;

constexpr int rows = 21, columns = 33, steps = 200;

solver::Scene rigid_scene() {
  solver::Scene scene;
  scene.grid = {rows, columns, 0.6};
  scene.time.t_end = steps * scene.time.dt;
  scene.output.every = scene.time.t_end;
  return scene;
}

solver::Scene coupled_scene() {
  solver::Scene scene = rigid_scene();
  scene.mechanics.emplace();
  scene.mechanics->cells_per_element = 4;
  scene.mechanics->interval = 20;
  scene.mechanics->tolerance = 1e-12;
  return scene;
}

// A front of about three nodes' width, broken in the middle of the sheet, refractory on its left,
// with a ripple on every field so that no symmetry hides an exchanged index, and half-risen Ta.
reference::ExcitationState broken_front() {
  reference::ExcitationState state;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double ripple = std::sin(0.9 * j + 0.4 * i) * std::cos(0.5 * j - 0.8 * i);
      const double behind = 0.5 - 0.5 * std::tanh((j - 16.0) / 1.5);
      const double ahead = 0.5 + 0.5 * std::tanh((j - 10.0) / 1.5);
      const double lower = 0.5 - 0.5 * std::tanh((i - 10.0) / 1.5);
      state.V.push_back(0.95 * behind * ahead * lower + 0.02 + 0.02 * ripple);
      state.r.push_back(1.5 * (1 - ahead) + 0.1 + 0.1 * ripple);
      state.Ta.push_back(22 * behind * lower + 6 + 4 * ripple);
    }
  return state;
}

class LastNodes : public solver::OutputSink {
 public:
  void fields(const solver::Frame& frame) override {
    nodes.assign(frame.nodes.begin(), frame.nodes.end());
    t = frame.t;
  }
  bool wants_fields() const override { return true; }

  std::vector<double> nodes;
  double t = -1;
};

void expect_product_is_reference(const solver::Scene& scene) {
  const auto initial = broken_front();
  const auto expected = reference::run(scene, initial, steps);

  LastNodes sink;
  solver::RunSummary summary;
  const auto actual = solver::run(scene, {rows, columns, initial.V, initial.r, initial.Ta}, sink, summary);

  EXPECT_EQ(summary.steps, steps);
  EXPECT_NEAR(sink.t, scene.time.t_end, 1e-12);
  EXPECT_TRUE(all_close(actual.V, expected.fields.V, columns, {.absolute = 1e-12}));
  EXPECT_TRUE(all_close(actual.r, expected.fields.r, columns, {.absolute = 1e-12}));
  EXPECT_TRUE(all_close(actual.Ta, expected.fields.Ta, columns, {.absolute = 1e-10}));
  EXPECT_TRUE(all_close(sink.nodes, expected.nodes, 2, {.absolute = 1e-10}));
  EXPECT_EQ(summary.mechanics.solves, expected.solves);
}

TEST(ReferenceCoupled, Rigid) { expect_product_is_reference(rigid_scene()); }

TEST(ReferenceCoupled, RigidPrintedTension) {
  solver::Scene scene = rigid_scene();
  scene.tension.law = solver::TensionLaw::printed;
  expect_product_is_reference(scene);
}

TEST(ReferenceCoupled, RigidStimulated) {
  solver::Scene scene = rigid_scene();
  solver::Stimulus disc;
  disc.start = 0.4;
  disc.duration = 0.6;
  disc.amplitude = 0.8;
  disc.shape = solver::Stimulus::Shape::disc;
  disc.center = {25, 14};
  disc.radius = 3.5;
  solver::Stimulus block;
  block.start = 1;
  block.period = 1.4;
  block.duration = 0.2;
  block.count = 2;
  block.amplitude = 0.5;
  block.shape = solver::Stimulus::Shape::block;
  block.columns = {20, 32};
  block.rows = {0, 1};
  scene.stimuli = {disc, block};
  expect_product_is_reference(scene);
}

TEST(ReferenceCoupled, OtherCellAndConduction) {
  solver::Scene scene = coupled_scene();
  scene.excitation = {{.k = 7, .a = 0.13, .b = 0.11, .eps = 0.012, .mu1 = 0.07, .mu2 = 0.35}, 1.25, 0.8};
  expect_product_is_reference(scene);
}

TEST(ReferenceCoupled, WithoutContraction) {
  solver::Scene scene = coupled_scene();
  scene.mechanics->contraction = false;
  expect_product_is_reference(scene);
}

TEST(ReferenceCoupled, FixedEdges) {
  solver::Scene scene = coupled_scene();
  scene.mechanics->edges = solver::Edges::fixed;
  expect_product_is_reference(scene);
}

TEST(ReferenceCoupled, IntervalThatDoesNotDivideTheRun) {
  solver::Scene scene = coupled_scene();
  scene.mechanics->interval = 27;
  expect_product_is_reference(scene);
}

class BetweenSolves : public ::testing::TestWithParam<MetricTime> {};

TEST_P(BetweenSolves, IsTheReference) {
  solver::Scene scene = coupled_scene();
  scene.metric_time = GetParam();
  scene.mechanics->interval = 10;
  expect_product_is_reference(scene);
}

std::string between_name(const ::testing::TestParamInfo<BetweenSolves::ParamType>& info) {
  return info.param == MetricTime::held ? "held" : info.param == MetricTime::linear ? "linear" : "quadratic";
}

INSTANTIATE_TEST_SUITE_P(ReferenceCoupled, BetweenSolves,
                         ::testing::Values(MetricTime::held, MetricTime::linear, MetricTime::quadratic),
                         between_name);

class EveryCoupling : public ::testing::TestWithParam<std::tuple<MetricForm, solver::Load, std::string>> {};

TEST_P(EveryCoupling, IsTheReference) {
  solver::Scene scene = coupled_scene();
  const auto& [metric, load, law] = GetParam();
  scene.metric = metric;
  scene.mechanics->load = load;
  scene.tension.law = solver::tension_law(law);
  expect_product_is_reference(scene);
}

std::string coupling_name(const ::testing::TestParamInfo<EveryCoupling::ParamType>& info) {
  const auto& [metric, load, law] = info.param;
  const std::string form = metric == MetricForm::none           ? "none"
                           : metric == MetricForm::conservative ? "conservative"
                                                                : "expanded";
  return form + (load == solver::Load::follower ? "_follower_" : "_dead_") + law;
}

INSTANTIATE_TEST_SUITE_P(ReferenceCoupled, EveryCoupling,
                         ::testing::Combine(::testing::Values(MetricForm::none, MetricForm::conservative,
                                                              MetricForm::expanded),
                                            ::testing::Values(solver::Load::follower, solver::Load::dead),
                                            ::testing::Values("delayed", "printed")),
                         coupling_name);

}  // namespace
}  // namespace myowave
