// Several steps in one launch against single ones (kernels/tissue/tiled_step.hpp).
#include "kernels/tissue/tiled_step.hpp"

#include <gtest/gtest.h>

#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/observe/probes.hpp"
#include "kernels/tissue/monodomain_step.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "solver/excitation/select_model.hpp"
#include "tests/support/allclose.hpp"
#include "tests/support/fields.hpp"

namespace myowave {
namespace {

using test::ExecutionSpace;
using test::MemorySpace;
using test::Sheet;
using test::Values;
using testing_support::all_close;

constexpr double dt = 0.02;
constexpr int members = 2;

template <class Real>
using Fields = tissue::ExcitationFields<EnsembleField<Real, MemorySpace>>;

template <class Real>
Fields<Real> random_state(const Sheet& sheet) {
  const auto field = [&](double low, double high, unsigned seed) {
    return test::to_view<Real>(sheet.rows, sheet.columns,
                               {test::random_field(sheet.size(), low, high, seed),
                                test::random_field(sheet.size(), low, high, seed + 1)});
  };
  return {field(-0.1, 1.1, 1), field(0, 2, 3), field(0, 50, 5)};
}

template <class Real>
Fields<Real> empty_state(const Sheet& sheet) {
  using View = EnsembleField<Real, MemorySpace>;
  return {View("V", members, sheet.rows, sheet.columns), View("r", members, sheet.rows, sheet.columns),
          View("Ta", members, sheet.rows, sheet.columns)};
}

template <class Real, tissue::Stencil stencil = tissue::Stencil::five_point>
tissue::ConservativeDiffusion<Real, MemorySpace, stencil> loaded(const Sheet& sheet) {
  const tissue::ConservativeMetric<Real, MemorySpace, stencil> metric(members, sheet.grid());
  const transfer::ConservativeTransfer<ExecutionSpace, Real, stencil> transfer(sheet.grid(), sheet.elements(),
                                                                               sheet.cells);
  for (int m = 0; m < members; ++m)
    transfer.refresh(ExecutionSpace(), test::to_nodes(test::crumpled(sheet.mesh(), 7)), metric, m);
  return {sheet.grid(), metric};
}

template <class Real, class Scheme>
solver::Model<Real, Scheme> model_of() {
  return solver::in_scheme<Scheme>(solver::make_model<Real>({}, {}));
}

template <class Real, class Scheme = tissue::ForwardEuler, class Diffusion>
Fields<Real> single_steps(const Sheet& sheet, const Diffusion& diffusion, int steps) {
  auto state = random_state<Real>(sheet), next = empty_state<Real>(sheet);
  for (int n = 0; n < steps; ++n) {
    tissue::monodomain_step(ExecutionSpace(), diffusion, model_of<Real, Scheme>(), dt, state.V, state.r,
                            state.Ta, next.V);
    std::swap(state.V, next.V);
  }
  return state;
}

template <class Real, int lag = tissue::tile_lag<ExecutionSpace>, class Scheme = tissue::ForwardEuler,
          class Diffusion>
Fields<Real> one_launch(const Sheet& sheet, const Diffusion& diffusion, const tissue::TileLayout& layout) {
  using Step =
      tissue::TiledStep<ExecutionSpace, Diffusion, solver::Model<Real, Scheme>, tissue::NoRecorder, lag>;
  const auto state = random_state<Real>(sheet), next = empty_state<Real>(sheet);
  Step::launch(ExecutionSpace(), diffusion, model_of<Real, Scheme>(), dt, layout, state, next);
  return next;
}

template <class Real>
void expect_equal(const Fields<Real>& actual, const Fields<Real>& expected, int columns,
                  testing_support::Tolerance tolerance = {}) {
  for (int m = 0; m < members; ++m) {
    EXPECT_TRUE(all_close(test::to_values(actual.V, m), test::to_values(expected.V, m), columns, tolerance));
    EXPECT_TRUE(all_close(test::to_values(actual.r, m), test::to_values(expected.r, m), columns, tolerance));
    EXPECT_TRUE(
        all_close(test::to_values(actual.Ta, m), test::to_values(expected.Ta, m), columns, tolerance));
  }
}

// The smallest sheet; one row of tiles; several tiles each way with ends of every length.
const std::array<std::pair<Sheet, tissue::TileLayout>, 6> tilings{{
    {Sheet{2, 2, 1}, {2, 2, 1}},
    {Sheet{5, 33, 4}, {5, 33, 1}},
    {Sheet{37, 41, 4}, {11, 16, 1}},
    {Sheet{129, 67, 2}, {40, 32, 1}},
    {Sheet{65, 301, 4}, {33, 160, 1}},
    {Sheet{21, 1031, 10}, {7, 256, 1}},
}};

class TiledStep : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  const Sheet sheet = tilings[std::get<0>(GetParam())].first;
  const int depth = std::get<1>(GetParam());
  const tissue::TileLayout layout = [&] {
    auto p = tilings[std::get<0>(GetParam())].second;
    p.depth = depth;
    return p;
  }();

  template <class Real>
  void expect_single_steps() const {
    const tissue::IdentityDiffusion<Real, MemorySpace> identity(sheet.grid());
    expect_equal(one_launch<Real>(sheet, identity, layout), single_steps<Real>(sheet, identity, depth),
                 sheet.columns);
    const auto conservative = loaded<Real>(sheet);
    expect_equal(one_launch<Real>(sheet, conservative, layout),
                 single_steps<Real>(sheet, conservative, depth), sheet.columns);
  }

  template <class Real>
  void expect_single_split_steps() const {
    using Scheme = tissue::SplitStep;
    constexpr auto nine_point = tissue::Stencil::nine_point;
    const auto expect_same = [&](const auto& diffusion) {
      const auto expected = single_steps<Real, Scheme>(sheet, diffusion, depth);
      expect_equal(one_launch<Real, 1, Scheme>(sheet, diffusion, layout), expected, sheet.columns);
      expect_equal(one_launch<Real, 2, Scheme>(sheet, diffusion, layout), expected, sheet.columns);
    };
    expect_same(tissue::IdentityDiffusion<Real, MemorySpace, nine_point>(sheet.grid()));
    expect_same(loaded<Real, nine_point>(sheet));
  }
};

TEST_P(TiledStep, Float64IsSingleStepsToTheBit) { expect_single_steps<double>(); }
TEST_P(TiledStep, Float32IsSingleStepsToTheBit) { expect_single_steps<float>(); }

TEST_P(TiledStep, SplitStepsAreSingleOnesToTheBit) {
  expect_single_split_steps<double>();
  expect_single_split_steps<float>();
}

// The rows in flight and their order are then those of a device.
TEST_P(TiledStep, ADevicesLagIsSingleStepsToTheBit) {
  const auto conservative = loaded<double>(sheet);
  expect_equal(one_launch<double, 2>(sheet, conservative, layout),
               single_steps<double>(sheet, conservative, depth), sheet.columns);
  const auto conservative32 = loaded<float>(sheet);
  expect_equal(one_launch<float, 2>(sheet, conservative32, layout),
               single_steps<float>(sheet, conservative32, depth), sheet.columns);
}

std::string name_of(const ::testing::TestParamInfo<std::tuple<int, int>>& test) {
  const Sheet& tiled = tilings[std::get<0>(test.param)].first;
  return std::to_string(tiled.rows) + "x" + std::to_string(tiled.columns) + "_depth" +
         std::to_string(std::get<1>(test.param));
}

INSTANTIATE_TEST_SUITE_P(TiledStep, TiledStep,
                         ::testing::Combine(::testing::Range(0, static_cast<int>(tilings.size())),
                                            ::testing::Values(1, 2, 3, 7, 20)),
                         name_of);

const Sheet sheet{71, 91, 10};

TEST(TiledSteps, AnyNumberOfStepsInEqualLaunches) {
  const auto diffusion = loaded<double>(sheet);
  for (const int steps : {1, 10, 37, 80}) {
    auto state = random_state<double>(sheet), spare = empty_state<double>(sheet);
    tissue::tiled_steps(ExecutionSpace(), diffusion, solver::make_model<double>({}, {}), dt, steps, state,
                        spare);
    expect_equal(state, single_steps<double>(sheet, diffusion, steps), sheet.columns);
  }
}

// The members of an ensemble take several passes in one launch, to and fro.
TEST(TiledSteps, SweepsOverWholeSheetsAreSingleSteps) {
  constexpr int depth = 7;
  const auto diffusion = loaded<double>(sheet);
  using Step = tissue::TiledStep<ExecutionSpace, std::decay_t<decltype(diffusion)>, solver::Model<double>,
                                 tissue::NoRecorder>;
  for (const int passes : {2, 5}) {
    const auto state = random_state<double>(sheet), next = empty_state<double>(sheet);
    Step::launch(ExecutionSpace(), diffusion, solver::make_model<double>({}, {}), dt,
                 {sheet.rows, sheet.columns, depth, passes}, state, next);
    expect_equal(passes % 2 == 1 ? next : state, single_steps<double>(sheet, diffusion, depth * passes),
                 sheet.columns);
  }
}

TEST(TiledSteps, WithoutTensionVAndRAreTheSame) {
  const auto diffusion = loaded<double>(sheet);
  const auto model = solver::make_model<double>({}, {});
  using Model = tissue::MonodomainModel<cell::AlievPanfilov<double>, cell::NoTension>;
  auto state = random_state<double>(sheet), spare = empty_state<double>(sheet);
  state.Ta = spare.Ta = {};
  tissue::tiled_steps(ExecutionSpace(), diffusion, Model{model.cell, {}, model.D, model.inverse_C_m}, dt, 20,
                      state, spare);
  const auto expected = single_steps<double>(sheet, diffusion, 20);
  for (int m = 0; m < members; ++m) {
    EXPECT_EQ(test::to_values(state.V, m), test::to_values(expected.V, m));
    EXPECT_EQ(test::to_values(state.r, m), test::to_values(expected.r, m));
  }
}

TEST(TiledSteps, ProbesSeeVBeforeEveryStep) {
  constexpr int steps = 33, first_step = 4;
  const std::array<std::int64_t, 3> probes{0, 40 * sheet.columns + 90, 70 * sheet.columns + 13};
  const Kokkos::View<std::int64_t*, MemorySpace> nodes("nodes", probes.size());
  Kokkos::deep_copy(nodes,
                    Kokkos::View<const std::int64_t*, Kokkos::HostSpace>(probes.data(), probes.size()));
  const Kokkos::View<double**, Kokkos::LayoutRight, MemorySpace> record("record", first_step + steps,
                                                                        probes.size());
  const tissue::IdentityDiffusion<double, MemorySpace> diffusion(sheet.grid());
  auto state = random_state<double>(sheet), spare = empty_state<double>(sheet);
  const auto model = solver::make_model<double>({}, {});
  tissue::tiled_steps(
      ExecutionSpace(), diffusion, model, dt, steps, state, spare, first_step,
      observe::ProbeRecorder<solver::Model<double>, MemorySpace>{nodes, record, {model, dt}, sheet.columns});
  const auto recorded = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, record);
  for (int n = 0; n < steps; ++n) {
    const Values V = test::to_values(single_steps<double>(sheet, diffusion, n).V);
    for (std::size_t p = 0; p < probes.size(); ++p)
      ASSERT_EQ(recorded(first_step + n, p), V[probes[p]]) << n << ' ' << p;
  }
}

// Every node belongs to one tile and tiles are as wide as the scratch rows allow.
TEST(TiledSteps, LayoutsCoverTheSheetAndKeepTeamsBusy) {
  using Step = tissue::TiledStep<ExecutionSpace, tissue::IdentityDiffusion<double, MemorySpace>,
                                 solver::Model<double>, tissue::NoRecorder>;
  const ExecutionSpace space;
  const int teams = space.concurrency();
  for (const int n : {2, 121, 251, 1024, 4091}) {
    const auto layout = Step::Tiles::choose_tiles(space, {n, n, 0.6}, 1, 8);
    EXPECT_LE(layout.columns, Step::Tiles::widest_tile);
    EXPECT_TRUE(layout.columns == n || layout.columns % Step::Tiles::line == 0);
    EXPECT_EQ(layout.depth, 8);
    const int tiles = tissue::tiles_of(n, layout.rows) * tissue::tiles_of(n, layout.columns);
    EXPECT_GE(tiles, n >= 16 * teams ? teams : 1);
  }
  // Many members are parallel enough: no rows are computed twice, and no more passes than needed.
  EXPECT_EQ(Step::Tiles::choose_tiles(space, {121, 121, 0.6}, 64 * teams, 8).rows, 121);
  EXPECT_EQ(Step::Tiles::choose_passes(space, {121, 121, 0.6}, 64 * teams, 80),
            tissue::tiles_of(80, Step::Tiles::largest_depth()));
}

}  // namespace
}  // namespace myowave
