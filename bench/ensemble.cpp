// Many small sheets. ensemble / WHAT / float64|float32 / n / members:M, where WHAT is
//   launch|threads       rigid steps only, ten a call as between two samples: one launch for all members, or
//                        one thread a member
//   rigid|contracting    whole runs as in a sweep, with everything that observes them
#include "solver/run/ensemble.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "kernels/tissue/tiled_step.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave::bench {
namespace {

constexpr int n = 121;
constexpr int steps_between_samples = 10;  // 0.2 t.u.

struct Extent {
  int members;
  double duration;  // t.u.
  int steps() const { return static_cast<int>(std::lround(duration / dt)); }
  double cell_steps() const { return static_cast<double>(n) * n * members * steps(); }
};

void report_rate(benchmark::State& state, const Extent& extent) {
  state.counters["cell_steps_per_s"] = benchmark::Counter(
      extent.cell_steps() * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

template <class Real>
struct Sheets {
  using View = EnsembleField<Real, MemorySpace>;
  tissue::ExcitationFields<View> state, spare;

  explicit Sheets(int members)
      : state{View("myowave::bench::V", members, n, n), View("myowave::bench::r", members, n, n), {}},
        spare{View("myowave::bench::V_next", members, n, n),
              View("myowave::bench::r_next", members, n, n),
              {}} {
    fill(state.V, [](int i, int j) { return static_cast<Real>(initial_V(i, j)); });
    fill(state.r, [](int i, int j) { return static_cast<Real>(initial_r(i, j)); });
  }

  void take(const solver::Execution& execution, int steps) {
    const tissue::IdentityDiffusion<Real, MemorySpace> diffusion(square_grid(n));
    const solver::Model<Real> model = solver::make_model<Real>({}, {});
    const solver::ModelWithoutTension<Real> rigid{model.cell, {}, model.D, model.inverse_C_m};
    for (int done = 0; done < steps; done += steps_between_samples)
      tissue::tiled_steps(execution.device, diffusion, rigid, dt, steps_between_samples, state, spare);
    execution.device.fence("myowave::bench::ensemble");
  }
};

template <class Real>
void time_launch(benchmark::State& state, const Extent& extent) {
  Sheets<Real> sheets(extent.members);
  measure(state, 1, [&] { sheets.take({}, extent.steps()); });
  report_rate(state, extent);
}

template <class Real>
void time_threads(benchmark::State& state, const Extent& extent) {
  std::vector<Sheets<Real>> sheets;
  for (int m = 0; m < extent.members; ++m) sheets.emplace_back(1);
  measure(state, 1, [&] {
    solver::run_members(sheets.size(), solver::most_workers(),
                        [&](std::size_t m, const solver::Execution& execution) {
                          sheets[m].take(execution, extent.steps());
                        });
  });
  report_rate(state, extent);
}

solver::Scene member(int number, const Extent& extent, bool contracts, solver::Precision precision) {
  solver::Scene scene;
  scene.grid = {n, n, dx};
  scene.time = {.dt = dt, .t_end = extent.duration};
  scene.excitation.mu1 = 0.0975 + 0.02 * number / extent.members;
  scene.precision = precision;
  if (contracts) scene.mechanics.emplace();
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.initial.offset = {-5, 40};  // the tip stays inside
  scene.output.tension = contracts;
  scene.output.every = 20;
  scene.output.probes = {{30, 30}, {30, 90}, {90, 30}, {90, 90}};
  return scene;
}

void time_runs(benchmark::State& state, const Extent& extent, bool contracts, solver::Precision precision) {
  std::vector<solver::Scene> scenes;
  for (int m = 0; m < extent.members; ++m) scenes.push_back(member(m, extent, contracts, precision));
  std::atomic<int> spirals;
  measure(state, 1, [&] {
    spirals = 0;
    solver::run_members(scenes.size(), solver::most_workers(),
                        [&](std::size_t m, const solver::Execution& execution) {
                          solver::OutputSink silent;
                          solver::RunSummary summary;
                          solver::run(scenes[m], solver::make_initial_state(scenes[m]), silent, summary,
                                      {.execution = execution});
                          if (!summary.observables.death_tu) ++spirals;
                        });
  });
  if (spirals != extent.members) fail(state, "a spiral died");
  report_rate(state, extent);
}

}  // namespace

void register_ensemble(const Suite& suite) {
  const Extent extent = suite.dry_run ? Extent{4, 2} : Extent{64, 100};
  const auto row = [&](const char* what, const char* precision) {
    return fmt::format("ensemble/{}/{}/{}/members:{}", what, precision, n, extent.members);
  };
  add_row(row("launch", "float64"), [=](benchmark::State& s) { time_launch<double>(s, extent); });
  add_row(row("launch", "float32"), [=](benchmark::State& s) { time_launch<float>(s, extent); });
  add_row(row("threads", "float64"), [=](benchmark::State& s) { time_threads<double>(s, extent); });
  add_row(row("threads", "float32"), [=](benchmark::State& s) { time_threads<float>(s, extent); });
  using enum solver::Precision;
  for (const bool contracts : {false, true})
    for (const auto precision : {float64, float32})
      add_row(row(contracts ? "contracting" : "rigid", precision == float64 ? "float64" : "float32"),
              [=](benchmark::State& s) { time_runs(s, extent, contracts, precision); });
}

}  // namespace myowave::bench
