// Parts that a scene does not need are not allocated or computed; the other results are bitwise identical.
// The plan lists what is left out and the memory of the rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "apps/input/scene_file.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/make_plan.hpp"
#include "solver/run/run.hpp"
#include "solver/run/stages.hpp"
#include "tests/support/plain_sheet.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using solver::MetricForm;
using solver::Scene;
using test::PlainSheet;
using test::to_values;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int interval = 20, intervals = 10;

Scene front(int n = 41) {
  Scene scene;
  scene.grid = {n, n, 0.6};
  scene.time.t_end = interval * intervals * scene.time.dt;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.probes = {{10, 10}, {20, 30}};
  return scene;
}

Scene deforming_front() {
  Scene scene = front();
  scene.mechanics.emplace().interval = interval;
  return scene;
}

// A pattern of Ta that pulls the sheet out of shape.
solver::InitialState tense_front(const Scene& scene) {
  solver::InitialState state = solver::make_initial_state(scene);
  state.Ta = test::smooth_random_field(state.rows, state.columns, 3);
  for (double& Ta : state.Ta) Ta = 10 + 5 * Ta;
  return state;
}

// Labels of Kokkos' allocations and launches, and the largest total of the project's Views in bytes.
struct Recording {
  std::vector<std::string> allocations, kernels;
  std::uint64_t bytes = 0, most_bytes = 0;
};
Recording* recording = nullptr;

template <class Action>
Recording record(const Action& action) {
  namespace tools = Kokkos::Tools::Experimental;
  Recording result;
  recording = &result;
  const auto add_kernel = [](const char* label, std::uint32_t, std::uint64_t*) {
    recording->kernels.emplace_back(label);
  };
  tools::set_begin_parallel_for_callback(add_kernel);
  tools::set_begin_parallel_reduce_callback(add_kernel);
  tools::set_allocate_data_callback(
      [](Kokkos::Tools::SpaceHandle, const char* label, const void*, std::uint64_t bytes) {
        if (!std::string(label).starts_with("myowave::")) return;  // what Kokkos itself works in
        recording->allocations.emplace_back(label);
        recording->bytes += bytes;
        recording->most_bytes = std::max(recording->most_bytes, recording->bytes);
      });
  tools::set_deallocate_data_callback(
      [](Kokkos::Tools::SpaceHandle, const char* label, const void*, std::uint64_t bytes) {
        if (std::string(label).starts_with("myowave::")) recording->bytes -= bytes;
      });
  action();
  tools::set_begin_parallel_for_callback(nullptr);
  tools::set_begin_parallel_reduce_callback(nullptr);
  tools::set_allocate_data_callback(nullptr);
  tools::set_deallocate_data_callback(nullptr);
  recording = nullptr;
  return result;
}

long launches(const Recording& seen, const std::string& prefix) {
  return std::ranges::count_if(seen.kernels, [&](const auto& label) { return label.starts_with(prefix); });
}

const solver::PlannedPart& part(const solver::Plan& plan, const std::string& name) {
  return *std::ranges::find(plan.parts, name, &solver::PlannedPart::part);
}

TEST(Pruning, WithoutAnOutputOfTensionARigidSheetHasNone) {
  Scene scene = front();
  scene.stimuli.push_back({.start = 1, .amplitude = 0.5});  // single steps too
  for (const auto precision : {solver::Precision::float64, solver::Precision::float32}) {
    scene.precision = precision;
    scene.output.tension = true;
    const test::RecordedRun full = test::recorded_run(scene);
    scene.output.tension = false;
    test::RecordedRun pruned;
    const Recording seen = record([&] { pruned = test::recorded_run(scene); });
    EXPECT_EQ(pruned.state.V, full.state.V);
    EXPECT_EQ(pruned.state.r, full.state.r);
    EXPECT_EQ(pruned.summary.observables.tips.mean, full.summary.observables.tips.mean);
    EXPECT_EQ(pruned.state.Ta, std::vector<double>(full.state.Ta.size()));
    EXPECT_THAT(seen.allocations, Not(Contains(HasSubstr("Ta"))));
    const auto& tension = part(pruned.summary.plan, "active tension");
    EXPECT_FALSE(tension.active);
    EXPECT_THAT(tension.why, HasSubstr("output.tension"));
    ASSERT_EQ(pruned.sink.probe_samples.size(), full.sink.probe_samples.size());
    for (std::size_t n = 0; n < full.sink.probe_samples.size(); ++n) {
      std::vector<double> values = full.sink.probe_samples[n].values;
      for (std::size_t p = 2; p < values.size(); p += 3) values[p] = 0;
      EXPECT_EQ(pruned.sink.probe_samples[n].values, values);
    }
  }
}

TEST(Pruning, AContractingSheetAndItsPreconditionHaveTension) {
  Scene scene = deforming_front();
  scene.initial.preconditions = {{1, false, scene.excitation, scene.tension}};
  const test::RecordedRun shown = test::recorded_run(scene);
  scene.output.tension = false;
  const test::RecordedRun pruned = test::recorded_run(scene);
  EXPECT_EQ(pruned.state.V, shown.state.V);
  EXPECT_EQ(pruned.state.Ta, shown.state.Ta);
  EXPECT_TRUE(has_tension(solver::stages_of(scene).front()));
  scene.mechanics.reset();
  EXPECT_FALSE(has_tension(solver::stages_of(scene).front()));
}

// Tension that is constant, that is zero, and that does not load the sheet.
struct StillCase {
  const char* name;
  void (*change)(Scene&);
  int solves;
};

class StillSheet : public ::testing::TestWithParam<std::tuple<StillCase, MetricForm, solver::MetricTime>> {};

TEST_P(StillSheet, IsNotSolvedAgainAndIsBitwiseIdentical) {
  const auto& [still, metric, time] = GetParam();
  Scene scene = deforming_front();
  scene.metric = metric;
  scene.metric_time = time;
  still.change(scene);
  const auto initial = tense_front(scene);
  const PlainSheet full(scene, initial);
  test::RecordedRun pruned;
  const Recording seen = record([&] { pruned = test::recorded_run(scene, initial); });
  EXPECT_EQ(pruned.state.V, to_values(full.V));
  EXPECT_EQ(pruned.state.r, to_values(full.r));
  EXPECT_EQ(pruned.state.Ta, to_values(full.Ta));
  EXPECT_EQ(pruned.sink.nodes, full.nodes);
  EXPECT_EQ(pruned.summary.mechanics.solves, still.solves);
  EXPECT_EQ(pruned.summary.mechanics.solves + pruned.summary.mechanics.left_out, intervals + 1);
  EXPECT_GT(*std::ranges::max_element(pruned.state.V), 0.9) << "nothing happened";

  const long metrics = launches(seen, "myowave::transfer::") - launches(seen, "myowave::transfer::tension");
  const long kernels_of_a_metric = metric == MetricForm::none ? 0 : 2;
  EXPECT_EQ(metrics, kernels_of_a_metric) << "made once";
}

INSTANTIATE_TEST_SUITE_P(
    Cases, StillSheet,
    ::testing::Combine(
        ::testing::Values(StillCase{"frozen", [](Scene& s) { s.tension.eps_below = s.tension.eps_above = 0; },
                                    1},
                          StillCase{"unfelt", [](Scene& s) { s.mechanics->contraction = false; }, 0}),
        ::testing::Values(MetricForm::none, MetricForm::conservative, MetricForm::expanded),
        ::testing::Values(solver::MetricTime::held, solver::MetricTime::quadratic)),
    [](const auto& one) {
      const auto metric = std::get<1>(one.param);
      return std::string(std::get<0>(one.param).name) +
             (metric == MetricForm::none       ? "_none"
              : metric == MetricForm::expanded ? "_expanded"
                                               : "_conservative") +
             (std::get<2>(one.param) == solver::MetricTime::held ? "" : "_quadratic");
    });

// A wave that starts later: solves are left out until Ta changes, and none after that.
TEST(Pruning, SolvesStartWhenTheTensionChanges) {
  Scene scene = deforming_front();
  scene.initial.type = solver::InitialSettings::Type::rest;
  constexpr int still = 5;
  scene.stimuli.push_back({.start = (still * interval - 1) * scene.time.dt, .amplitude = 0.5});
  const test::RecordedRun result = test::recorded_run(scene);
  EXPECT_EQ(result.summary.mechanics.left_out, still + 1);  // at step 100 V has risen, Ta not yet
  EXPECT_EQ(result.summary.mechanics.solves, intervals - still);
  EXPECT_EQ(result.sink.areas.front().total, 1);
  EXPECT_LT(result.summary.observables.area->first, 0.95);
}

TEST(Pruning, UnneededPartsAreNotAllocatedOrComputed) {
  Scene scene = front();
  scene.output.probes.clear();
  const Recording rigid = record([&] { test::recorded_run(scene); });
  for (const auto* labels : {&rigid.allocations, &rigid.kernels}) {
    EXPECT_THAT(*labels, Not(Contains(StartsWith("myowave::elastic"))));
    EXPECT_THAT(*labels, Not(Contains(StartsWith("myowave::transfer"))));
    EXPECT_THAT(*labels, Not(Contains(HasSubstr("metric"))));
    EXPECT_THAT(*labels, Not(Contains(HasSubstr("area"))));
    EXPECT_THAT(*labels, Not(Contains("myowave::solver::nodes")));
  }
  Scene without_feedback = deforming_front();
  without_feedback.metric = MetricForm::none;
  const Recording deforming = record([&] { test::recorded_run(without_feedback); });
  EXPECT_THAT(deforming.allocations, Not(Contains(HasSubstr("metric"))));
  EXPECT_THAT(deforming.allocations, Not(Contains(StartsWith("myowave::transfer"))));
  EXPECT_EQ(launches(deforming, "myowave::transfer::"),
            launches(deforming, "myowave::transfer::tension_to_gauss"));
}

// A noisy sheet has more tips than the initial capacity.
TEST(Pruning, MemoryForTipsGrowsWithTheirNumber) {
  Scene scene = front(81);
  scene.time.t_end = 0;
  auto state = solver::make_initial_state(scene);
  state.V = test::random_field(81 * 81, 0, 1, 5);
  const test::RecordedRun result = test::recorded_run(scene, state);
  const auto& tips = result.sink.tip_samples.front().tips;
  EXPECT_GT(tips.size(), 300U);
  EXPECT_EQ(result.summary.observables.tips.mean, static_cast<double>(tips.size()));
}

std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(MYOWAVE_SOURCE_DIR "/apps/scenes"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

// A few intervals of each shipped scene, as it is and in other variants.
TEST(Plan, CountsTheBytesThatKokkosAllocates) {
  for (const auto& file : shipped_scenes()) {
    for (const char* variant : {"accuracy.on_unstable=substep", "mechanics.on=false",
                                "feedback.metric=expanded", "feedback.metric=none", "feedback.time=quadratic",
                                "accuracy.precision=float32", "output.maps=true"}) {
      Scene scene = apps::read_scene(file, {variant});
      scene.initial = {};
      scene.initial.type = solver::InitialSettings::Type::broken_front;
      scene.time.t_end = 100 * scene.time.dt;
      const Recording seen = record([&] { test::recorded_run(scene); });
      const solver::Plan plan = solver::make_plan(scene);
      double views = 0;
      for (const auto& [space, bytes] : views_of(plan)) views += static_cast<double>(bytes);
      EXPECT_NEAR(views / static_cast<double>(seen.most_bytes), 1, 0.05)
          << file.stem() << " " << variant << ": " << views << " planned, " << seen.most_bytes
          << " allocated";
      EXPECT_EQ(solver::memory_bytes(scene), plan.bytes());
    }
  }
}

TEST(Plan, NamesEveryPartAndSaysWhy) {
  const Scene rigid = front(), contracting = deforming_front();
  for (const Scene& scene : {rigid, contracting}) {
    const solver::Plan plan = solver::make_plan(scene);
    for (const auto& one : plan.parts) {
      EXPECT_FALSE(one.why.empty()) << one.part;
      EXPECT_EQ(one.active, !one.what.empty()) << one.part;
      EXPECT_TRUE(one.active || one.bytes() == 0) << one.part;
    }
    for (const char* name : {"mechanics", "contraction", "feedback", "areas"})
      EXPECT_EQ(part(plan, name).active, scene.mechanics.has_value()) << name;
  }
}

}  // namespace
}  // namespace myowave
