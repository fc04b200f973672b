// A contracting sheet, and a kernel of this program on the last state of the run.
#include <Kokkos_Core.hpp>
#include <cstdio>

#include "kernels/cell/aliev_panfilov.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

int main() {
  const Kokkos::ScopeGuard kokkos;
  myowave::solver::Scene scene;
  scene.name = "outside";
  scene.grid = {.rows = 41, .columns = 41, .dx = 0.6};
  scene.time.t_end = 20;
  scene.output.period_from = 0;
  scene.mechanics.emplace();
  scene.initial.type = myowave::solver::InitialSettings::Type::broken_front;

  myowave::solver::OutputSink nowhere;
  myowave::solver::RunSummary summary;
  const auto end = myowave::solver::run(scene, make_initial_state(scene), nowhere, summary);

  const Kokkos::View<const double*, Kokkos::HostSpace> V(end.V.data(), end.V.size()),
      r(end.r.data(), end.r.size());
  const myowave::cell::AlievPanfilov<double> cell;
  double fastest = 0;
  Kokkos::parallel_reduce(
      "outside::fastest", Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace>(0, end.V.size()),
      KOKKOS_LAMBDA(std::size_t n, double& value) {
        value = Kokkos::max(value, Kokkos::abs(cell.excitation(V(n), r(n))));
      },
      Kokkos::Max<double>(fastest));
  std::printf("t = %g, %d solves, shortening %.3f, |f| up to %.3f\n", summary.t,
              static_cast<int>(summary.mechanics.solves), summary.observables.shortening->first, fastest);
}
