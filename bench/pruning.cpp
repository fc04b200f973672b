// Time saved by leaving out what a scene does not need:
//   pruning / tension|feedback|contraction|mechanics|solve / n / full|pruned
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "solver/base/error.hpp"
#include "solver/coupling/electromechanics.hpp"
#include "solver/mechanics/equilibrium.hpp"

namespace myowave::bench {
namespace {

constexpr int interval = 80;  // steps between solves
constexpr int small_n = 121;

// Float64, with tension, contraction and feedback.
solver::Scene full_model(int n) {
  solver::Scene scene;
  scene.grid = {n, n, dx};
  scene.time.dt = dt;
  scene.excitation = turbulent_excitation();
  scene.mechanics.emplace().interval = interval;
  scene.output.probes = {{n / 2, n / 2}};
  return scene;
}

solver::Scene rigid_with_tension(int n) {
  solver::Scene scene = full_model(n);
  scene.mechanics.reset();
  return scene;
}

solver::Scene rigid(int n) {
  solver::Scene scene = rigid_with_tension(n);
  scene.output.tension = false;
  return scene;
}

solver::Scene without_feedback(int n) {
  solver::Scene scene = full_model(n);
  scene.metric = solver::MetricForm::none;
  return scene;
}

solver::Scene without_contraction(int n) {
  solver::Scene scene = full_model(n);
  scene.mechanics->contraction = false;
  scene.output.tension = false;
  return scene;
}

// One iteration is an interval of a turbulent sheet and the solve that is due after it.
void time_interval(benchmark::State& state, const solver::Scene& scene) {
  const int n = scene.grid.rows;
  solver::PhaseSeconds phases;
  solver::MechanicsStatistics statistics;
  try {
    solver::Electromechanics<ExecutionSpace, double> sheet(solver::Execution{}, scene, turbulent_state(n),
                                                           phases, statistics);
    if (scene.mechanics) sheet.solve_mechanics(0);
    std::int64_t step = 0;
    measure(state, 1, [&] {
      sheet.advance(step, interval);
      step += interval;
      if (scene.mechanics) sheet.solve_mechanics(static_cast<double>(step) * dt);
    });
    if (const auto problem = sheet.check_state(static_cast<double>(step) * dt, dt)) fail(state, *problem);
  } catch (const solver::NumericalFailure& failure) {
    fail(state, failure.what());
    return;
  }
  state.counters["cell_steps_per_s"] =
      benchmark::Counter(static_cast<double>(n) * n * interval * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

// One iteration is the due solve when no tension has changed. Full: a solve that starts at its solution, and
// the metric of the same nodes. Pruned: the check that the tension has not changed.
void time_still_solve(benchmark::State& state, int n, bool full) {
  using Host = Kokkos::DefaultHostExecutionSpace;
  using Metric = tissue::ConservativeMetric<double, MemorySpace>;
  const Host host;
  const auto elements = square_elements(n);
  const auto& values = turbulent_tension((n - 1) / cells_per_element)[0];
  const GaussTension<Host::memory_space> tension("myowave::bench::gauss_tension", elements.elements());
  std::copy(values.begin(), values.end(), tension.data());
  solver::Equilibrium<Host> equilibrium(host, elements, {});
  equilibrium.solve(host, tension, 0);
  const Nodes<MemorySpace> nodes("myowave::bench::nodes", elements.nodes());
  const Metric metric(1, square_grid(n));
  const transfer::ConservativeTransfer<ExecutionSpace, double> transfer(square_grid(n), elements,
                                                                        cells_per_element);
  bool same = true;
  measure(state, 1, [&] {
    if (full) {
      same = same && equilibrium.solve(host, tension, 0).iterations == 0;
      Kokkos::deep_copy(nodes, equilibrium.nodes());
      transfer.refresh(ExecutionSpace(), nodes, metric, 0);
    } else {
      same = same && equilibrium.is_solved_for(host, tension);
    }
  });
  if (!same) fail(state, "the sheet is not in equilibrium");
}

}  // namespace

void register_pruning(const Suite& suite) {
  const int n = suite.dry_run ? small_n : 251;
  const auto pair = [n](const char* what, const solver::Scene& full, const solver::Scene& pruned) {
    add_row(fmt::format("pruning/{}/{}/full", what, n),
            [=](benchmark::State& state) { time_interval(state, full); });
    add_row(fmt::format("pruning/{}/{}/pruned", what, n),
            [=](benchmark::State& state) { time_interval(state, pruned); });
  };
  pair("tension", rigid_with_tension(n), rigid(n));
  pair("feedback", full_model(n), without_feedback(n));
  pair("contraction", full_model(n), without_contraction(n));
  pair("mechanics", full_model(n), rigid(n));
  for (const bool full : {true, false})
    add_row(fmt::format("pruning/solve/{}/{}", n, full ? "full" : "pruned"),
            [=](benchmark::State& state) { time_still_solve(state, n, full); });
}

}  // namespace myowave::bench
