// mechanics.overlap: conduction feels the deformation of one interval before, and the thread that
// solves meanwhile changes no bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "kernels/transfer/tension_to_gauss.hpp"
#include "solver/denormals.hpp"
#include "solver/equilibrium.hpp"
#include "solver/error.hpp"
#include "solver/run.hpp"
#include "solver/select_model.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;
using Host = Kokkos::DefaultHostExecutionSpace;
using ::testing::HasSubstr;

constexpr int interval = 40;

solver::Scene overlapping(int steps) {
  solver::Scene scene;
  scene.grid = {81, 61, 0.6};
  scene.time.t_end = steps * scene.time.dt;
  scene.mechanics.emplace();
  scene.mechanics->interval = interval;
  scene.mechanics->overlap = true;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.every = interval * scene.time.dt;
  return scene;
}

struct Result {
  solver::InitialState state;
  test::RecordingSink sink;
  solver::RunSummary summary;
};

Result run(const solver::Scene& scene) {
  Result result;
  result.sink.keep_fields = true;
  result.state = solver::run(scene, solver::make_initial_state(scene), result.sink, result.summary);
  return result;
}

// The same in one thread and in plain order: each interval is stepped with the nodes of the tension at
// the begin of the one before, the first with those of its own.
struct PlainSheet {
  using View = EnsembleField<double, Memory>;
  View V, V_next, r, Ta;
  std::vector<double> nodes;  // the metric's

  static View upload(const char* label, const solver::InitialState& state,
                     const std::vector<double>& values) {
    View view(label, 1, state.rows, state.columns);
    const auto host = Kokkos::create_mirror_view(view);
    std::ranges::copy(values, host.data());
    Kokkos::deep_copy(view, host);
    return view;
  }

  PlainSheet(const solver::Scene& scene, const solver::InitialState& state)
      : V(upload("V", state, state.V)),
        V_next("V_next", 1, state.rows, state.columns),
        r(upload("r", state, state.r)),
        Ta(upload("Ta", state, state.Ta)) {
    const Space space;
    const Host host;
    const auto& mechanics = *scene.mechanics;
    const int cells = mechanics.cells_per_element;
    const tissue::Grid grid{state.rows, state.columns, scene.grid.dx};
    const elastic::ElementGrid elements{(state.rows - 1) / cells, (state.columns - 1) / cells,
                                        cells * scene.grid.dx};
    using Forms = solver::ModelForms<Space, double>;
    auto any = solver::select_form<Space, double>(scene.metric, grid, elements, cells);
    auto& form = std::get<Forms::Conservative>(any);
    const auto model = solver::make_model<double>(scene.excitation, scene.tension);

    solver::Equilibrium<Host> equilibrium(host, elements, mechanics);
    const GaussTension<Memory> tension("tension", elements.elements());
    const auto tension_host = Kokkos::create_mirror_view(tension);
    const Nodes<Memory> now("nodes", elements.nodes()), before("nodes before", elements.nodes());
    equilibrium.solve(host, tension_host, 0);  // the loaded rest state

    const auto steps = std::llround(scene.time.t_end / scene.time.dt);
    for (std::int64_t step = 0; step < steps; ++step) {
      if (step % mechanics.interval == 0) {
        transfer::tension_to_gauss<Space, double>(space, elements, cells, Ta, 0, tension);
        Kokkos::deep_copy(tension_host, tension);
        equilibrium.solve(host, tension_host, 0);
        Kokkos::deep_copy(before, now);
        Kokkos::deep_copy(now, equilibrium.nodes());
        if (step == 0) Kokkos::deep_copy(before, now);
        form.transfer.refresh(space, before, form.diffusion.metric, 0);
      }
      tissue::monodomain_step(space, form.diffusion, model, scene.time.dt, V, r, Ta, V_next);
      std::swap(V, V_next);
    }
    const auto metric_nodes = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, before);
    nodes.assign(metric_nodes.data(), metric_nodes.data() + metric_nodes.size());
  }

  static std::vector<double> download(const View& view) {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
    return {host.data(), host.data() + host.size()};
  }
};

TEST(Overlap, IsTheMetricOfOneIntervalBeforeToTheBit) {
  const solver::Scene scene = overlapping(6 * interval + interval / 2);
  const Result result = run(scene);
  solver::flush_denormals();
  const PlainSheet plain(scene, solver::make_initial_state(scene));
  EXPECT_EQ(result.state.V, PlainSheet::download(plain.V));
  EXPECT_EQ(result.state.r, PlainSheet::download(plain.r));
  EXPECT_EQ(result.state.Ta, PlainSheet::download(plain.Ta));
  // What is shown is the sheet that conduction feels.
  EXPECT_EQ(result.sink.nodes, plain.nodes);

  solver::Scene held = scene;
  held.mechanics->overlap = false;
  EXPECT_NE(run(held).state.V, result.state.V);
}

TEST(Overlap, TheSameRunTwiceIsTheSameToTheBit) {
  const solver::Scene scene = overlapping(5 * interval);
  const Result one = run(scene), two = run(scene);
  EXPECT_EQ(one.state.V, two.state.V);
  EXPECT_EQ(one.sink.nodes, two.sink.nodes);
  EXPECT_EQ(one.summary.mechanics.newton_iterations, two.summary.mechanics.newton_iterations);
}

TEST(Overlap, EverySolveThatIsDueIsDone) {
  for (const int steps : {0, 1, interval, 3 * interval, 3 * interval + 1}) {
    solver::Scene scene = overlapping(steps);
    const Result overlapped = run(scene);
    scene.mechanics->overlap = false;
    EXPECT_EQ(overlapped.summary.mechanics.solves, run(scene).summary.mechanics.solves) << steps;
    EXPECT_EQ(overlapped.summary.mechanics.solves, steps / interval + 1) << steps;
  }
}

// The area of each sample is that of a held run of the same interval, one interval later. The two
// runs differ through the feedback, which is off here.
TEST(Overlap, AreasComeOneIntervalLater) {
  solver::Scene scene = overlapping(5 * interval);
  scene.metric = solver::MetricForm::none;
  const Result overlapped = run(scene);
  scene.mechanics->overlap = false;
  const Result held = run(scene);
  ASSERT_EQ(overlapped.sink.areas.size(), 6U);
  EXPECT_EQ(overlapped.sink.areas[0].total, held.sink.areas[0].total);
  for (std::size_t n = 1; n < 6; ++n) {
    EXPECT_EQ(overlapped.sink.areas[n].total, held.sink.areas[n - 1].total);
    EXPECT_NE(held.sink.areas[n].total, held.sink.areas[n - 1].total);
  }
  // No solve is lost to the summary.
  EXPECT_EQ(overlapped.summary.observables.area, held.summary.observables.area);
  EXPECT_EQ(overlapped.summary.observables.shortening, held.summary.observables.shortening);
}

// No equilibrium at the first solve that sees tension, step 40.
TEST(Overlap, AFailureNamesTheTimeOfItsTensionAndSurfacesAtTheNextSolveOrTheEnd) {
  for (const auto& [steps, reached] : {std::pair{10 * interval, 2 * interval}, std::pair{60, 60}}) {
    solver::Scene scene = overlapping(steps);
    scene.grid = {41, 41, 0.6};
    scene.tension.k_Ta = 1e5;
    test::RecordingSink sink;
    solver::RunSummary summary;
    try {
      solver::run(scene, solver::make_initial_state(scene), sink, summary);
      ADD_FAILURE() << "no failure";
    } catch (const solver::NumericalFailure& failure) {
      EXPECT_THAT(failure.what(), HasSubstr("mechanics at t = 0.8 t.u.: no equilibrium found"));
    }
    EXPECT_EQ(summary.steps, reached);
  }
}

// The steps fail while the solve begun before them is at work, and it ends first.
TEST(Overlap, AFailureOfTheStepsWaitsForTheSolve) {
  solver::Scene scene = overlapping(10 * interval);
  scene.stimuli.push_back({.start = 1.7, .duration = 1, .amplitude = 200});
  EXPECT_THROW(run(scene), solver::NumericalFailure);
}

}  // namespace
}  // namespace myowave
