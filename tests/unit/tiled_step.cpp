// Several steps in one launch against single ones (kernels/tissue/tiled_step.hpp).
#include "kernels/tissue/tiled_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/observe/probes.hpp"
#include "kernels/tissue/monodomain_step.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "solver/denormals.hpp"
#include "solver/select_model.hpp"
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
Fields<Real> one_launch(const Sheet& sheet, const Diffusion& diffusion, const tissue::TilePlan& plan) {
  using Step =
      tissue::TiledStep<ExecutionSpace, Diffusion, solver::Model<Real, Scheme>, tissue::NoRecorder, lag>;
  const auto state = random_state<Real>(sheet), next = empty_state<Real>(sheet);
  Step::launch(ExecutionSpace(), diffusion, model_of<Real, Scheme>(), dt, plan, state, next);
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
const std::array<std::pair<Sheet, tissue::TilePlan>, 6> tilings{{
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
  const tissue::TilePlan plan = [&] {
    auto p = tilings[std::get<0>(GetParam())].second;
    p.depth = depth;
    return p;
  }();

  template <class Real>
  void expect_single_steps() const {
    const tissue::IdentityDiffusion<Real, MemorySpace> identity(sheet.grid());
    expect_equal(one_launch<Real>(sheet, identity, plan), single_steps<Real>(sheet, identity, depth),
                 sheet.columns);
    const auto conservative = loaded<Real>(sheet);
    expect_equal(one_launch<Real>(sheet, conservative, plan), single_steps<Real>(sheet, conservative, depth),
                 sheet.columns);
  }

  template <class Real>
  void expect_single_split_steps() const {
    using Scheme = tissue::SplitStep;
    constexpr auto nine_point = tissue::Stencil::nine_point;
    const auto expect_same = [&](const auto& diffusion) {
      const auto expected = single_steps<Real, Scheme>(sheet, diffusion, depth);
      expect_equal(one_launch<Real, 1, Scheme>(sheet, diffusion, plan), expected, sheet.columns);
      expect_equal(one_launch<Real, 2, Scheme>(sheet, diffusion, plan), expected, sheet.columns);
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

// The rows on the way and their order are then those of a device.
TEST_P(TiledStep, ADevicesLagIsSingleStepsToTheBit) {
  const auto conservative = loaded<double>(sheet);
  expect_equal(one_launch<double, 2>(sheet, conservative, plan),
               single_steps<double>(sheet, conservative, depth), sheet.columns);
  const auto conservative32 = loaded<float>(sheet);
  expect_equal(one_launch<float, 2>(sheet, conservative32, plan),
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

// The members of an ensemble take several sweeps in one launch, to and fro.
TEST(TiledSteps, SweepsOverWholeSheetsAreSingleSteps) {
  constexpr int depth = 7;
  const auto diffusion = loaded<double>(sheet);
  using Step = tissue::TiledStep<ExecutionSpace, std::decay_t<decltype(diffusion)>, solver::Model<double>,
                                 tissue::NoRecorder>;
  for (const int sweeps : {2, 5}) {
    const auto state = random_state<double>(sheet), next = empty_state<double>(sheet);
    Step::launch(ExecutionSpace(), diffusion, solver::make_model<double>({}, {}), dt,
                 {sheet.rows, sheet.columns, depth, sweeps}, state, next);
    expect_equal(sweeps % 2 == 1 ? next : state, single_steps<double>(sheet, diffusion, depth * sweeps),
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
TEST(TiledSteps, PlansCoverTheSheetAndKeepTeamsBusy) {
  using Step = tissue::TiledStep<ExecutionSpace, tissue::IdentityDiffusion<double, MemorySpace>,
                                 solver::Model<double>, tissue::NoRecorder>;
  const ExecutionSpace space;
  const int teams = space.concurrency();
  for (const int n : {2, 121, 251, 1024, 4091}) {
    const auto plan = Step::plan_tiles(space, {n, n, 0.6}, 1, 8);
    EXPECT_LE(plan.columns, Step::widest_tile);
    EXPECT_TRUE(plan.columns == n || plan.columns % Step::line == 0);
    EXPECT_EQ(plan.depth, 8);
    const int tiles = tissue::tiles_of(n, plan.rows) * tissue::tiles_of(n, plan.columns);
    EXPECT_GE(tiles, n >= 16 * teams ? teams : 1);
  }
  // Many members are parallel enough: no rows are computed twice, and no more sweeps than needed.
  EXPECT_EQ(Step::plan_tiles(space, {121, 121, 0.6}, 64 * teams, 8).rows, 121);
  EXPECT_EQ(Step::plan_sweeps(space, {121, 121, 0.6}, 64 * teams, 80),
            tissue::tiles_of(80, Step::largest_depth()));
}

// At rest but for V = 0.5 on a few nodes of each member: in a corner, or in the inside.
template <class Real>
Fields<Real> spots(const Sheet& at, bool corners) {
  const auto spot = [&](double row, double column) {
    Values V(at.size());
    const int first_row = static_cast<int>(row * (at.rows - 4)),
              first_column = static_cast<int>(column * (at.columns - 4));
    for (int i = first_row; i < first_row + 4; ++i)
      for (int j = first_column; j < first_column + 4; ++j) V[i * at.columns + j] = 0.5;
    return V;
  };
  auto state = empty_state<Real>(at);
  state.V = corners ? test::to_view<Real>(at.rows, at.columns, {spot(0, 1), spot(0.1, 0.9)})
                    : test::to_view<Real>(at.rows, at.columns, {spot(0.4, 0.6), spot(0.5, 0.7)});
  return state;
}

template <class View>
bool same_bits(const View& a, const View& b) {
  const auto left = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, a),
             right = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, b);
  return std::equal(left.data(), left.data() + left.size(), right.data(), right.data() + right.size(),
                    [](auto x, auto y) { return std::memcmp(&x, &y, sizeof(x)) == 0; });
}

// Rounds of 37 steps with the active box and without it: the same bits, or with a tolerance up to a hundred
// times that, for r and Ta go to k (1 + b) and k_Ta times V. Returns the share of the sheet that does not
// rest before each round.
template <class Diffusion, class Model>
std::vector<double> active_shares(const Sheet& at, const Diffusion& diffusion, const Model& model,
                                  bool corners, double tolerance = 0) {
  using Real = typename Diffusion::Scalar;
  auto state = spots<Real>(at, corners), spare = empty_state<Real>(at);
  auto all = spots<Real>(at, corners), all_spare = empty_state<Real>(at);
  if (!Model::has_tension) state.Ta = spare.Ta = all.Ta = all_spare.Ta = {};
  tissue::ActiveBox<Real> active(at.grid(), tolerance, 1);
  std::vector<double> shares;
  for (int round = 0; round < 12; ++round) {
    const auto box = tissue::ActiveBox<Real>(at.grid(), tolerance, 1).find(state, spare, 0, 1);
    shares.push_back(static_cast<double>(box.rows()) * box.columns() / at.size());
    tissue::tiled_steps(ExecutionSpace(), diffusion, model, dt, 37, state, spare, 0, {}, &active);
    tissue::tiled_steps(ExecutionSpace(), diffusion, model, dt, 37, all, all_spare);
    if (tolerance > 0)
      expect_equal(state, all, at.columns, {.absolute = 100 * tolerance});
    else
      EXPECT_TRUE(same_bits(state.V, all.V) && same_bits(state.r, all.r) && same_bits(state.Ta, all.Ta))
          << "after " << round + 1 << " rounds";
  }
  return shares;
}

template <class Real>
void expect_the_bits_of_the_whole_sheet() {
  const auto model = solver::make_model<Real>({}, {});
  const tissue::MonodomainModel<cell::AlievPanfilov<Real>, cell::NoTension> without_tension{
      model.cell, {}, model.D, model.inverse_C_m};
  for (const Sheet& at : {Sheet{101, 71, 10}, Sheet{41, 321, 10}})
    for (const bool corners : {true, false}) {
      const tissue::IdentityDiffusion<Real, MemorySpace> identity(at.grid());
      const auto conservative = loaded<Real>(at);
      for (const auto& shares : {active_shares(at, identity, model, corners),
                                 active_shares(at, identity, without_tension, corners),
                                 active_shares(at, conservative, model, corners),
                                 active_shares(at, conservative, without_tension, corners)}) {
        EXPECT_LT(shares.front(), 0.1);
        EXPECT_LT(shares[1], 0.9);
        EXPECT_GT(shares.back(), shares[1]);
      }
    }
}

TEST(TiledSteps, LeavingOutWhatRestsChangesNoBit) {
  if (!runs_on_host<ExecutionSpace>) GTEST_SKIP() << "a device takes the whole sheet";
  solver::flush_denormals();  // as runs do; here and in the tests below
  expect_the_bits_of_the_whole_sheet<double>();
  expect_the_bits_of_the_whole_sheet<float>();
}

// Probes in the box and outside, until the front of a corner has passed the nearest.
TEST(TiledSteps, ProbesOutsideTheActiveBoxSeeVBeforeEveryStep) {
  if (!runs_on_host<ExecutionSpace>) GTEST_SKIP() << "a device takes the whole sheet";
  constexpr int steps = 57;
  const Sheet at{101, 71, 10};
  const std::array<std::int64_t, 4> probes{0, 70, 30 * at.columns + 40, 100 * at.columns};
  const Kokkos::View<std::int64_t*, MemorySpace> nodes("nodes", probes.size());
  Kokkos::deep_copy(nodes,
                    Kokkos::View<const std::int64_t*, Kokkos::HostSpace>(probes.data(), probes.size()));
  using Record = Kokkos::View<double**, Kokkos::LayoutRight, MemorySpace>;
  const auto record_of = [&](bool leave_out) {
    const Record record("record", steps + 1, probes.size());
    Kokkos::deep_copy(record, -1);
    auto state = spots<double>(at, true), spare = empty_state<double>(at);
    tissue::ActiveBox<double> active(at.grid(), 0, 1);
    const auto model = solver::make_model<double>({}, {});
    tissue::tiled_steps(
        ExecutionSpace(), tissue::IdentityDiffusion<double, MemorySpace>(at.grid()), model, dt, steps, state,
        spare, 1,
        observe::ProbeRecorder<solver::Model<double>, MemorySpace>{nodes, record, {model, dt}, at.columns},
        leave_out ? &active : nullptr);
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, record);
  };
  const auto record = record_of(true);
  EXPECT_TRUE(same_bits(record, record_of(false)));
  EXPECT_GT(record(steps, 2), 0);
  EXPECT_EQ(record(steps, 3), 0);
}

// A medium that no wave crosses and that forgets in a few t.u.: the box grows, shrinks and is empty in the
// end. Without a tolerance it would not be: where a step's change of a tiny number is denormal, the number
// stays.
template <class Real>
void expect_a_sheet_that_dies() {
  const auto model = solver::make_model<Real>({.a = 0.8, .k = 30, .eps = 20}, {.eps_below = 20});
  const Sheet at{81, 91, 10};
  for (const bool corners : {true, false}) {
    const auto shares = active_shares(at, loaded<Real>(at), model, corners, 1e-30);
    EXPECT_GT(*std::ranges::max_element(shares), shares.front());
    EXPECT_EQ(shares.back(), 0);
    const auto shrinks = std::ranges::adjacent_find(shares, std::greater());
    ASSERT_NE(shrinks, shares.end());
    EXPECT_GT(*(shrinks + 1), 0);
  }
}

TEST(TiledSteps, ASheetThatDiesRestsInTheEnd) {
  if (!runs_on_host<ExecutionSpace>) GTEST_SKIP() << "a device takes the whole sheet";
  expect_a_sheet_that_dies<double>();
  expect_a_sheet_that_dies<float>();
}

}  // namespace
}  // namespace myowave
