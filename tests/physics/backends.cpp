// A scene on every execution space of the build, and on the default one with a single thread. Host spaces are
// bitwise identical; a device is within the bounds below.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <functional>
#include <string>
#include <vector>

#include "solver/coupling/electromechanics.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/allclose.hpp"

namespace myowave {
namespace {

using solver::ExecutionOn;
using solver::Scene;

constexpr int interval = 40, intervals = 8;

// Largest difference of V, r and nodes (order 1 to 10) after 6.4 t.u. by a device's fused multiply-adds and
// order of sums: rounding, amplified by the motion of the front.
constexpr double device_bound = 1e-9, device_bound_float = 1e-3;

struct Outcome {
  std::string space;
  bool on_host = true;
  solver::InitialState state;
  std::vector<double> nodes;
  std::vector<solver::Tip> tips;
};

template <class Real, class ExecutionSpace>
Outcome outcome_on(const ExecutionOn<ExecutionSpace>& execution, const Scene& scene) {
  solver::PhaseSeconds phases;
  solver::MechanicsStatistics statistics;
  solver::Electromechanics<ExecutionSpace, Real> sheet(execution, scene, solver::make_initial_state(scene),
                                                       phases, statistics);
  std::int64_t step = 0;
  const auto time = [&] { return static_cast<double>(step) * scene.time.dt; };
  for (int n = 0; n < intervals; ++n, step += interval) {
    if (sheet.deforms()) sheet.solve_mechanics(time());
    sheet.advance(step, interval);
  }
  return {.space = fmt::format("{}, {} threads", ExecutionSpace::name(), execution.device.concurrency()),
          .on_host = runs_on_host<ExecutionSpace>,
          .state = sheet.download(),
          .nodes = sheet.deforms() ? sheet.download_nodes() : std::vector<double>(),
          .tips = sheet.find_tips(time()).tips};
}

// The first one is what the others are compared with.
template <class Real>
std::vector<Outcome> outcomes_of(const Scene& scene) {
  std::vector<Outcome> all{outcome_on<Real>(ExecutionOn<Kokkos::DefaultHostExecutionSpace>{}, scene)};
  if (const auto one_thread = solver::own_host_instance(1))
    all.push_back(
        outcome_on<Real>(ExecutionOn<Kokkos::DefaultHostExecutionSpace>{*one_thread, *one_thread}, scene));
#ifdef MYOWAVE_HAS_SERIAL_TOO
  all.push_back(outcome_on<Real>(ExecutionOn<Kokkos::Serial>{}, scene));
#endif
#ifdef MYOWAVE_HAS_DEVICE
  all.push_back(outcome_on<Real>(solver::Execution{}, scene));
#endif
  return all;
}

struct Case {
  const char* name;
  std::function<void(Scene&)> change;
};

const std::vector<Case> cases{
    {"rigid", [](Scene& s) { s.mechanics.reset(); }},
    {"conservative", [](Scene&) {}},
    {"expanded", [](Scene& s) { s.metric = solver::MetricForm::expanded; }},
    {"split",
     [](Scene& s) {
       s.scheme = solver::Scheme::split;
       s.metric_time = solver::MetricTime::quadratic;
     }},
    {"fixed_edges", [](Scene& s) { s.mechanics->edges = solver::Edges::fixed; }},
    {"stimulated",
     [](Scene& s) {
       s.stimuli.push_back({.start = 1,
                            .duration = 1,
                            .amplitude = 1,
                            .shape = solver::Stimulus::Shape::disc,
                            .center = {50, 15},
                            .radius = 5});
     }},
    {"single_precision", [](Scene& s) { s.precision = solver::Precision::float32; }},
};

class Backends : public ::testing::TestWithParam<Case> {};

TEST_P(Backends, Agree) {
  Scene scene;
  scene.grid = {51, 71, 0.6};
  scene.mechanics.emplace().interval = interval;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  GetParam().change(scene);
  const bool single = scene.precision == solver::Precision::float32;
  const auto all = single ? outcomes_of<float>(scene) : outcomes_of<double>(scene);

  const Outcome& first = all.front();
  EXPECT_GE(first.tips.size(), 1U) << "the scene should have a spiral";
  for (const Outcome& other : all) {
    SCOPED_TRACE(other.space + " against " + first.space);
    const double bound = other.on_host ? 0 : single ? device_bound_float : device_bound;
    const auto agree = [&](const std::vector<double>& a, const std::vector<double>& b) {
      return testing_support::all_close(a, b, scene.grid.columns, {.absolute = bound});
    };
    EXPECT_TRUE(agree(other.state.V, first.state.V));
    EXPECT_TRUE(agree(other.state.r, first.state.r));
    EXPECT_TRUE(agree(other.state.Ta, first.state.Ta));
    EXPECT_TRUE(agree(other.nodes, first.nodes));
    EXPECT_EQ(other.tips.size(), first.tips.size());
  }
  std::string spaces;
  for (const Outcome& one : all) spaces += (spaces.empty() ? "" : "; ") + one.space;
  RecordProperty("spaces", spaces);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Backends, ::testing::ValuesIn(cases),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace myowave
