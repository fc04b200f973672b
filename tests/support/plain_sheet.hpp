// The coupled run in one thread and in plain order, with nothing left out: every step alone, and every
// interval a solve, a metric and its Ta, whether or not anything has changed.
#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include "kernels/transfer/tension_to_gauss.hpp"
#include "solver/base/denormals.hpp"
#include "solver/coupling/node_history.hpp"
#include "solver/coupling/select_form.hpp"
#include "solver/excitation/select_model.hpp"
#include "solver/mechanics/equilibrium.hpp"
#include "solver/run/run.hpp"
#include "tests/support/fields.hpp"

namespace myowave::test {

struct PlainSheet {
  using Host = Kokkos::DefaultHostExecutionSpace;
  using View = EnsembleField<double, MemorySpace>;
  View V, V_next, r, Ta;
  Values nodes;

  PlainSheet(const solver::Scene& scene, const solver::InitialState& state)
      : V(to_view<double>(state.rows, state.columns, {state.V})),
        V_next("V_next", 1, state.rows, state.columns),
        r(to_view<double>(state.rows, state.columns, {state.r})),
        Ta(to_view<double>(state.rows, state.columns, {state.Ta})) {
    const solver::FlushDenormals flush;
    const int cells = scene.mechanics->cells_per_element;
    const Sheet sheet{state.rows, state.columns, cells, scene.grid.dx};
    auto form =
        solver::select_form<ExecutionSpace, double>(scene.metric, sheet.grid(), sheet.elements(), cells);
    std::visit([&](auto& one) { advance(scene, sheet, one); }, form);
  }

 private:
  template <class Form>
  void advance(const solver::Scene& scene, const Sheet& sheet, Form& form) {
    const ExecutionSpace space;
    const Host host;
    const auto& mechanics = *scene.mechanics;
    const auto elements = sheet.elements();
    const auto model = solver::make_model<double>(scene.excitation, scene.tension);
    solver::Equilibrium<Host> equilibrium(host, elements, mechanics);
    const GaussTension<MemorySpace> tension("tension", elements.elements());
    const auto tension_host = Kokkos::create_mirror_view(tension);
    const Nodes<MemorySpace> felt("nodes felt", elements.nodes());
    const Nodes<Kokkos::HostSpace> now("nodes", elements.nodes());
    solver::NodeHistory solved(elements, solver::solves_of_metric(scene));
    equilibrium.solve(host, tension_host, 0);  // the loaded rest state

    const auto steps = std::llround(scene.time.t_end / scene.time.dt);
    for (std::int64_t step = 0; step <= steps; ++step) {
      const auto t = [&](std::int64_t at) { return static_cast<double>(at) * scene.time.dt; };
      if (step % mechanics.interval == 0) {
        if (mechanics.contraction)
          transfer::tension_to_gauss<ExecutionSpace, double>(space, elements, sheet.cells, Ta, 0, tension);
        Kokkos::deep_copy(tension_host, tension);
        equilibrium.solve(host, tension_host, 0);
        Kokkos::deep_copy(now, equilibrium.nodes());
        solved.add(t(step), now);
        Kokkos::deep_copy(felt, solved.at(t(step) + 0.5 * mechanics.interval * scene.time.dt));
        if constexpr (requires { form.transfer; })
          form.transfer.refresh(space, felt, form.diffusion.metric, 0);
      }
      if (step == steps) break;
      tissue::monodomain_step(space, form.diffusion, model, scene.time.dt, V, r, Ta, V_next);
      std::swap(V, V_next);
    }
    nodes.assign(solved.last().data(), solved.last().data() + solved.last().size());
  }
};

}  // namespace myowave::test
