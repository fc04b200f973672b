// The coupled run of a turbulent sheet, and the start-up of a run:
//   coupled / float64|float32 / n / interval:STEPS      startup / n
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "solver/base/error.hpp"
#include "solver/coupling/electromechanics.hpp"

namespace myowave::bench {
namespace {

constexpr int small_n = 121;

solver::Scene turbulence(int n, int interval) {
  solver::Scene scene;
  scene.grid = {n, n, dx};
  scene.time.dt = dt;
  scene.excitation = turbulent_excitation();
  scene.mechanics.emplace();
  scene.mechanics->interval = interval;
  scene.output.probes = {{n / 2, n / 2}};
  return scene;
}

template <class Real>
using CoupledSheet = solver::Electromechanics<ExecutionSpace, Real>;

// One iteration is `steps` steps from the same turbulent state, with a solve before every `interval`.
template <class Real>
void time_coupled(benchmark::State& state, int n, int interval, int steps) {
  const solver::Scene scene = turbulence(n, interval);
  const solver::InitialState& initial = turbulent_state(n);
  solver::PhaseSeconds phases;
  solver::MechanicsStatistics statistics;
  std::optional<CoupledSheet<Real>> sheet;
  try {
    for (auto _ : state) {
      state.PauseTiming();
      sheet.emplace(solver::Execution{}, scene, initial, phases, statistics);
      sheet->solve_mechanics(0);  // outside the timing: this solve starts from an uncontracted sheet
      phases = {};
      statistics = {};
      Kokkos::fence("myowave::bench::before");
      state.ResumeTiming();
      for (int step = 0; step < steps; step += interval) {
        sheet->advance(step, interval);
        sheet->solve_mechanics((step + interval) * dt);
      }
      Kokkos::fence("myowave::bench::after");
    }
    if (const auto problem = sheet->check_state(steps * dt, dt)) throw solver::NumericalFailure(*problem);
    state.counters["tips"] = static_cast<double>(sheet->find_tips(steps * dt).tips.size());
  } catch (const solver::NumericalFailure& failure) {
    fail(state, failure.what());
    return;
  }
  state.counters["cell_steps_per_s"] =
      benchmark::Counter(static_cast<double>(n) * n * steps * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
  // Of the last iteration.
  const double total = phases.excitation + phases.transfer + phases.mechanics + phases.observe;
  const auto solves = static_cast<double>(statistics.solves);
  state.counters["percent_mechanics"] = 100 * phases.mechanics / total;
  state.counters["percent_transfer"] = 100 * phases.transfer / total;
  state.counters["solve_s"] = phases.mechanics / solves;
  state.counters["iterations"] = static_cast<double>(statistics.newton_iterations) / solves;
  state.counters["factorizations"] = static_cast<double>(statistics.factorizations) / solves;
  state.counters["min_J"] = statistics.min_J;
}

// From a scene to a sheet that can take its first step: allocation, analysis of the sparse system, loaded
// rest state.
void time_startup(benchmark::State& state, int n) {
  const solver::Scene scene = turbulence(n, 80);
  const auto size = static_cast<std::size_t>(n) * n;
  const solver::InitialState rest{n, n, std::vector<double>(size), std::vector<double>(size),
                                  std::vector<double>(size)};
  solver::PhaseSeconds phases;
  solver::MechanicsStatistics statistics;
  double shortening = 0;
  measure(state, 1, [&] {
    CoupledSheet<double> sheet(solver::Execution{}, scene, rest, phases, statistics);
    sheet.solve_mechanics(0);
    shortening = sheet.area().shortening;
  });
  if (!(shortening < 0)) fail(state, "the load does not stretch the sheet");
}

}  // namespace

void register_coupled(const Suite& suite) {
  const int steps = suite.dry_run ? 160 : 1600;
  const int n = suite.dry_run ? small_n : 251;
  for (const int interval : {80, 40, 20}) {
    const auto row = [=](const char* precision) {
      return fmt::format("coupled/{}/{}/interval:{}", precision, n, interval);
    };
    add_row(row("float64"),
            [=](benchmark::State& state) { time_coupled<double>(state, n, interval, steps); });
    add_row(row("float32"), [=](benchmark::State& state) { time_coupled<float>(state, n, interval, steps); });
  }
  for (const int size : suite.sizes({121, 251, 1021}, small_n))
    add_row(fmt::format("startup/{}", size), [=](benchmark::State& state) { time_startup(state, size); });
}

}  // namespace myowave::bench
