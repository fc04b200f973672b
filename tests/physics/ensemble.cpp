// A member of an ensemble is bitwise identical to the run alone, for any other members, order and number of
// threads.
#include "solver/run/ensemble.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

#include "solver/base/error.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/own_process.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

solver::Scene spiral(double mu1, bool contracts, solver::Precision precision) {
  solver::Scene scene;
  scene.grid = {71, 61, 0.6};
  scene.time.t_end = 12;
  scene.excitation.mu1 = mu1;
  scene.precision = precision;
  if (contracts) {
    scene.mechanics.emplace();
    scene.mechanics->interval = 30;
  }
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.probes = {{20, 20}};
  return scene;
}

std::vector<solver::Scene> members() {
  std::vector<solver::Scene> scenes;
  for (const double mu1 : {0.1, 0.11, 0.12})
    for (const bool contracts : {false, true}) {
      scenes.push_back(spiral(mu1, contracts, solver::Precision::float64));
      scenes.push_back(spiral(mu1, contracts, solver::Precision::float32));
    }
  scenes[2].on_unstable = solver::OnUnstable::substep;
  scenes[0].initial.preconditions = {{.duration = 2, .contraction = false, .excitation = {}, .tension = {}}};
  return scenes;
}

struct Outcome {
  solver::InitialState state;
  std::vector<test::RecordingSink::TipSample> tips;
  std::int64_t iterations = 0;
  double min_area = 0;
};

Outcome outcome_of(const solver::Scene& scene, const solver::Execution& execution) {
  test::RecordingSink sink;
  solver::RunSummary summary;
  const solver::RunControl control{.execution = execution};
  Outcome outcome;
  outcome.state = solver::run(scene, solver::make_initial_state(scene), sink, summary, control);
  outcome.tips = sink.tip_samples;
  outcome.iterations = summary.mechanics.newton_iterations;
  outcome.min_area = summary.observables.area ? summary.observables.area->first : 1;
  return outcome;
}

void expect_equal(const Outcome& a, const Outcome& b) {
  EXPECT_TRUE(a.state.V == b.state.V && a.state.r == b.state.r && a.state.Ta == b.state.Ta);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.min_area, b.min_area);
  ASSERT_EQ(a.tips.size(), b.tips.size());
  for (std::size_t n = 0; n < a.tips.size(); ++n) {
    ASSERT_EQ(a.tips[n].tips.size(), b.tips[n].tips.size());
    for (std::size_t tip = 0; tip < a.tips[n].tips.size(); ++tip) {
      EXPECT_EQ(a.tips[n].tips[tip].x, b.tips[n].tips[tip].x);
      EXPECT_EQ(a.tips[n].tips[tip].trajectory, b.tips[n].tips[tip].trajectory);
    }
  }
}

// Runs the test in a process with cores for several workers, and shows its output if it failed.
void with_threads(int threads, const std::function<void()>& test) {
  if (Kokkos::DefaultExecutionSpace::name() != std::string("OpenMP"))
    GTEST_SKIP() << "the number of threads is not OpenMP's";
  if (test::report_path().empty())
    test::report_of_own_process("OMP_NUM_THREADS=" + std::to_string(threads));
  else
    test();
}

TEST(Ensemble, MembersAreBitwiseTheRunsAlone) {
  with_threads(3, [] {
    const auto scenes = members();
    std::vector<Outcome> alone(scenes.size());
    for (std::size_t n = 0; n < scenes.size(); ++n) alone[n] = outcome_of(scenes[n], {});
    for (const int workers : {3, 2}) {
      std::vector<Outcome> together(scenes.size());
      std::set<std::thread::id> threads;
      std::mutex mutex;
      solver::run_members(scenes.size(), workers, [&](std::size_t index, const solver::Execution& execution) {
        // Other neighbours than in the list.
        const std::size_t n = (index * 5 + 2) % scenes.size();
        together[n] = outcome_of(scenes[n], execution);
        const std::lock_guard lock(mutex);
        threads.insert(std::this_thread::get_id());
      });
      EXPECT_EQ(threads.size(), std::size_t(workers));
      for (std::size_t n = 0; n < scenes.size(); ++n) {
        SCOPED_TRACE(n);
        expect_equal(together[n], alone[n]);
      }
    }
  });
}

TEST(Ensemble, TakesEachMemberOnceAndEndsWithTheFirstError) {
  with_threads(3, [] {
    std::vector<std::atomic<int>> taken(100);
    solver::run_members(taken.size(), 3, [&](std::size_t n, const solver::Execution&) { ++taken[n]; });
    EXPECT_TRUE(std::ranges::all_of(taken, [](const auto& count) { return count == 1; }));

    std::atomic<int> begun = 0;
    const auto failing = [&](std::size_t n, const solver::Execution&) {
      ++begun;
      if (n == 4) throw solver::NumericalFailure("the fifth");
    };
    EXPECT_THROW(solver::run_members(1000000, 3, failing), solver::NumericalFailure);
    EXPECT_LT(begun, 1000000);
    solver::run_members(0, 3, [&](std::size_t, const solver::Execution&) { ADD_FAILURE(); });
  });
}

TEST(Ensemble, ARunStoppedOnRequestReportsIt) {
  const solver::Scene scene = spiral(0.1, true, solver::Precision::float64);
  const std::atomic<bool> stop = true;
  test::RecordingSink sink;
  solver::RunSummary summary;
  EXPECT_THROW(solver::run(scene, solver::make_initial_state(scene), sink, summary, {.stop = &stop}),
               solver::Interrupted);
  EXPECT_EQ(summary.steps, 0);
}

}  // namespace
}  // namespace myowave
