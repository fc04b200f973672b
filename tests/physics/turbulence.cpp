// The mechanics in a turbulent state: 251 x 251 nodes, mu1 = 0.07, 900 t.u. without contraction.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/transfer/tension_to_gauss.hpp"
#include "solver/mechanics/equilibrium.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

using Space = Kokkos::DefaultExecutionSpace;
using Memory = Space::memory_space;

solver::Scene turbulence() {
  solver::Scene scene;
  scene.grid = {251, 251, 0.6};
  scene.excitation.mu1 = 0.07;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.initial.width = 10;
  return scene;
}

const solver::InitialState& turbulent_state() {
  static const solver::InitialState state = [] {
    solver::Scene scene = turbulence();
    scene.time.t_end = 900;
    test::RecordingSink sink;
    solver::RunSummary summary;
    return solver::run(scene, solver::make_initial_state(scene), sink, summary);
  }();
  return state;
}

// Tension of the turbulent state at the Gauss points of 25 x 25 elements.
GaussTension<Memory> turbulent_tension(const elastic::ElementGrid& elements) {
  const auto& state = turbulent_state();
  EnsembleField<double, Memory> Ta("Ta", 1, state.rows, state.columns);
  const auto host = Kokkos::create_mirror_view(Ta);
  std::copy(state.Ta.begin(), state.Ta.end(), host.data());
  Kokkos::deep_copy(Ta, host);
  GaussTension<Memory> gauss("gauss", elements.elements());
  transfer::tension_to_gauss<Space, double>(Space(), elements, 10, Ta, 0, gauss);
  Space().fence();
  return gauss;
}

// Pi at equilibrium with the tension applied in equal parts from the undeformed state on.
solver::SolveReport solve_in_parts(int parts) {
  const elastic::ElementGrid elements{25, 25, 6.0};
  const auto full = turbulent_tension(elements);
  solver::Equilibrium<Space> sheet(Space(), elements, solver::MechanicsSettings{});
  GaussTension<Memory> part("part", elements.elements());
  solver::SolveReport report;
  for (int n = 1; n <= parts; ++n) {
    const double fraction = static_cast<double>(n) / parts;
    Kokkos::parallel_for(
        Kokkos::RangePolicy<Space>(0, elements.elements()), KOKKOS_LAMBDA(int e) {
          for (int q = 0; q < 4; ++q) part(e, q) = fraction * full(e, q);
        });
    Space().fence();
    report = sheet.solve(Space(), part, 0);
    EXPECT_GT(report.min_J, 0) << "part " << n << " of " << parts;
    EXPECT_LT(report.residual, 1e-8);
  }
  return report;
}

TEST(Turbulence, AColdStartReachesTheEnergyOfARamp) {
  const auto cold = solve_in_parts(1);
  EXPECT_NEAR(solve_in_parts(5).energy / cold.energy, 1, 1e-9);
  EXPECT_NEAR(solve_in_parts(20).energy / cold.energy, 1, 1e-9);
}

struct Case {
  const char* name;
  double p;
  solver::TensionLaw law;
};
class EveryLoad : public testing::TestWithParam<Case> {};

// No failure means that every solve came below its tolerance: equilibrium throws otherwise.
TEST_P(EveryLoad, RunsCoupledThroughTurbulence) {
  solver::Scene scene = turbulence();
  scene.time.t_end = 100;
  scene.initial.type = solver::InitialSettings::Type::file;
  scene.mechanics.emplace();
  scene.mechanics->p = GetParam().p;
  scene.tension.law = GetParam().law;
  test::RecordingSink sink;
  solver::RunSummary summary;
  solver::run(scene, turbulent_state(), sink, summary);
  EXPECT_EQ(summary.steps, 5000);
  EXPECT_EQ(summary.mechanics.solves, 63);
  EXPECT_GT(summary.mechanics.min_J, 0.2);
  EXPECT_GT(summary.observables.tips.mean, 3);
}

INSTANTIATE_TEST_SUITE_P(Turbulence, EveryLoad,
                         testing::Values(Case{"stretched", 10, solver::TensionLaw::delayed},
                                         Case{"unloaded", 0, solver::TensionLaw::delayed},
                                         Case{"compressed", -10, solver::TensionLaw::delayed},
                                         Case{"printed_law", 10, solver::TensionLaw::printed}),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace myowave
