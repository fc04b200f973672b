#include "kernels/tissue/monodomain_step.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <tuple>

#include "kernels/transfer/deformation_to_grid.hpp"
#include "solver/excitation/select_model.hpp"
#include "solver/excitation/stimulus_schedule.hpp"
#include "tests/support/allclose.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/reference_coupled.hpp"

namespace myowave {
namespace {

using solver::MetricForm;
using solver::Scheme;
using test::ExecutionSpace;
using test::MemorySpace;
using test::Sheet;
using test::Values;
using testing_support::all_close;
using testing_support::Tolerance;

// One lane, one short row, rows above a vector's width, a team's last row alone, many teams.
constexpr std::array sheets{Sheet{2, 2, 1}, Sheet{2, 7, 1}, Sheet{5, 33, 4}, Sheet{37, 41, 4},
                            Sheet{129, 67, 2}};

const solver::ExcitationSettings excitation{
    {.k = 7, .a = 0.13, .b = 0.11, .eps = 0.012, .mu1 = 0.07, .mu2 = 0.35}, 1.25, 0.8};
const solver::TensionSettings tension;
constexpr double dt = 0.02;

// State and nodes of one member.
struct Member {
  reference::ExcitationState state;
  Values nodes;
};

Member random_member(const Sheet& sheet, unsigned seed) {
  return {
      {test::random_field(sheet.size(), -0.1, 1.1, seed), test::random_field(sheet.size(), 0, 2, seed + 1),
       test::random_field(sheet.size(), 0, 50, seed + 2)},
      test::crumpled(sheet.mesh(), seed + 3)};
}

// The diffusion term of a step, and its scheme.
struct Kind {
  MetricForm form;
  Scheme scheme;
};

Values reference_diffusion(Kind kind, const Sheet& sheet, const Member& member) {
  const auto grid = sheet.reference_grid();
  const bool nine_point = kind.scheme == Scheme::split;
  switch (kind.form) {
    case MetricForm::conservative:
      return reference::diffusion_conservative(grid, sheet.mesh(), member.nodes, member.state.V,
                                               nine_point ? 1.0 / 12 : 0);
    case MetricForm::expanded:
      return reference::diffusion_expanded(grid, sheet.mesh(), member.nodes, member.state.V);
    case MetricForm::none:
      break;
  }
  return nine_point ? reference::diffusion_nine_point(grid, member.state.V)
                    : reference::diffusion_identity(grid, member.state.V);
}

reference::ExcitationState reference_step(Kind kind, const Sheet& sheet, const Member& member) {
  const Values diffusion = reference_diffusion(kind, sheet, member);
  return kind.scheme == Scheme::split
             ? reference::split_step(excitation, tension, dt, member.state, diffusion)
             : reference::euler_step(excitation, tension, dt, member.state, diffusion, Values(sheet.size()));
}

// The diffusion term in a form, on the metrics of all members; action(diffusion, model).
template <class Real, class TimeScheme, class Action>
void with_diffusion(MetricForm form, const Sheet& sheet, const std::vector<Member>& members,
                    const Action& act) {
  constexpr tissue::Stencil stencil = solver::stencil_of<TimeScheme>;
  const auto euler = solver::make_model<Real>(excitation, tension);
  const auto action = [&](const auto& diffusion) { act(diffusion, solver::in_scheme<TimeScheme>(euler)); };
  const ExecutionSpace space;
  const tissue::Grid grid = sheet.grid();
  const int count = static_cast<int>(members.size());
  const auto refresh = [&](const auto& transfer, const auto& metric) {
    for (int m = 0; m < count; ++m) transfer.refresh(space, test::to_nodes(members[m].nodes), metric, m);
  };
  switch (form) {
    case MetricForm::conservative: {
      const tissue::ConservativeMetric<Real, MemorySpace, stencil> metric(count, grid);
      refresh(
          transfer::ConservativeTransfer<ExecutionSpace, Real, stencil>(grid, sheet.elements(), sheet.cells),
          metric);
      return action(tissue::ConservativeDiffusion<Real, MemorySpace, stencil>(grid, metric));
    }
    case MetricForm::expanded: {
      const tissue::ExpandedMetric<Real, MemorySpace> metric(count, grid);
      refresh(transfer::ExpandedTransfer<ExecutionSpace, Real>(grid, sheet.elements(), sheet.cells), metric);
      return action(tissue::ExpandedDiffusion<Real, MemorySpace>(grid, metric));
    }
    case MetricForm::none:
      return action(tissue::IdentityDiffusion<Real, MemorySpace, stencil>(grid));
  }
}

template <class Real, class Action>
void with_diffusion(Kind kind, const Sheet& sheet, const std::vector<Member>& members, const Action& action) {
  if (kind.scheme == Scheme::split)
    with_diffusion<Real, tissue::SplitStep>(kind.form, sheet, members, action);
  else
    with_diffusion<Real, tissue::ForwardEuler>(kind.form, sheet, members, action);
}

template <class Real>
std::vector<reference::ExcitationState> stepped(Kind kind, const Sheet& sheet,
                                                const std::vector<Member>& members) {
  std::vector<Values> V, r, Ta;
  for (const Member& member : members) {
    V.push_back(member.state.V);
    r.push_back(member.state.r);
    Ta.push_back(member.state.Ta);
  }
  const auto V_view = test::to_view<Real>(sheet.rows, sheet.columns, V);
  const auto r_view = test::to_view<Real>(sheet.rows, sheet.columns, r);
  const auto Ta_view = test::to_view<Real>(sheet.rows, sheet.columns, Ta);
  const EnsembleField<Real, MemorySpace> V_next("V_next", members.size(), sheet.rows, sheet.columns);
  with_diffusion<Real>(kind, sheet, members, [&](const auto& diffusion, const auto& model) {
    tissue::monodomain_step(ExecutionSpace(), diffusion, model, dt, V_view, r_view, Ta_view, V_next);
  });
  std::vector<reference::ExcitationState> result;
  for (int m = 0; m < static_cast<int>(members.size()); ++m)
    result.push_back({test::to_values(V_next, m), test::to_values(r_view, m), test::to_values(Ta_view, m)});
  return result;
}

class Step : public ::testing::TestWithParam<std::tuple<Sheet, Kind>> {
 protected:
  const Sheet sheet = std::get<0>(GetParam());
  const Kind kind = std::get<1>(GetParam());

  template <class Real>
  void expect_reference(Tolerance tolerance) const {
    const Member member = random_member(sheet, 11);
    ASSERT_GT(reference::smallest_corner_J(sheet.mesh(), member.nodes), 0.1);
    const auto expected = reference_step(kind, sheet, member);
    const auto actual = stepped<Real>(kind, sheet, {member}).front();
    EXPECT_TRUE(all_close(actual.V, expected.V, sheet.columns, tolerance));
    EXPECT_TRUE(all_close(actual.r, expected.r, sheet.columns, tolerance));
    EXPECT_TRUE(all_close(actual.Ta, expected.Ta, sheet.columns, tolerance));
  }

  template <class Real>
  void expect_members_as_alone() const {
    const Member first = random_member(sheet, 21), second = random_member(sheet, 31);
    const auto together = stepped<Real>(kind, sheet, {first, second});
    for (int m = 0; m < 2; ++m) {
      const auto alone = stepped<Real>(kind, sheet, {m == 0 ? first : second}).front();
      EXPECT_EQ(together[m].V, alone.V);
      EXPECT_EQ(together[m].r, alone.r);
      EXPECT_EQ(together[m].Ta, alone.Ta);
    }
  }
};

TEST_P(Step, Float64IsTheReference) { expect_reference<double>({.absolute = 1e-14, .relative = 1e-14}); }

// Rounding to 6e-8 of terms up to dt 8 / (dx^2 min J) times V.
TEST_P(Step, Float32IsTheReferenceToItsRounding) {
  expect_reference<float>({.absolute = 2e-6, .relative = 4e-7});
}

TEST_P(Step, MembersAreIndependent) {
  expect_members_as_alone<double>();
  expect_members_as_alone<float>();
}

// More members than a cache holds, so that the step uses prefetch hints, against one alone.
template <class Real>
void expect_from_memory_as_from_cache(Kind kind) {
  const Sheet sheet{129, 67, 2};
  const Member member = random_member(sheet, 51);
  using Form = tissue::IdentityDiffusion<Real, MemorySpace>;
  constexpr auto cached_bytes =
      tissue::MonodomainStep<ExecutionSpace, Form, solver::Model<Real>>::cached_bytes;
  const std::size_t members = cached_bytes / (4 * sizeof(Real) * sheet.size()) + 1;
  const auto alone = stepped<Real>(kind, sheet, {member}).front();
  for (const auto& state : stepped<Real>(kind, sheet, std::vector<Member>(members, member))) {
    EXPECT_EQ(state.V, alone.V);
    EXPECT_EQ(state.r, alone.r);
    EXPECT_EQ(state.Ta, alone.Ta);
  }
}

TEST(MonodomainStep, FieldsFromMemoryAreSteppedAsThoseFromACache) {
  for (const MetricForm form : {MetricForm::none, MetricForm::conservative, MetricForm::expanded}) {
    expect_from_memory_as_from_cache<double>({form, Scheme::euler});
    expect_from_memory_as_from_cache<float>({form, Scheme::euler});
  }
}

template <class Rate>
Values rate_everywhere(const Sheet& sheet, const Rate& rate) {
  const EnsembleField<double, MemorySpace> result("rate", 1, sheet.rows, sheet.columns);
  Kokkos::parallel_for(
      "rate", Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<2>>({0, 0}, {sheet.rows, sheet.columns}),
      KOKKOS_LAMBDA(int i, int j) { result(0, i, j) = rate(0, i, j); });
  return test::to_values(result);
}

TEST_P(Step, RateIsTheIncrementOfAStep) {
  if (kind.scheme != Scheme::euler) GTEST_SKIP() << "an explicit Euler step alone adds dt times the rate";
  const Member member = random_member(sheet, 41);
  const Values next = stepped<double>(kind, sheet, {member}).front().V;
  Values expected(next.size());
  for (std::size_t n = 0; n < next.size(); ++n) expected[n] = (next[n] - member.state.V[n]) / dt;

  const Kokkos::View<tissue::ActiveStimulus*, MemorySpace> none;
  const auto V = test::to_view<double>(sheet.rows, sheet.columns, {member.state.V});
  const auto r = test::to_view<double>(sheet.rows, sheet.columns, {member.state.r});
  with_diffusion<double>(kind, sheet, {member}, [&](const auto& diffusion, const auto&) {
    using Rate = tissue::MonodomainRate<std::decay_t<decltype(diffusion)>, solver::Model<double>>;
    const Rate rate{diffusion, solver::make_model<double>(excitation, tension), V, r, none};
    EXPECT_TRUE(all_close(rate_everywhere(sheet, rate), expected, sheet.columns, {.absolute = 1e-12}));
  });
}

std::string name_of(const ::testing::TestParamInfo<Step::ParamType>& info) {
  const auto& [sheet, kind] = info.param;
  const std::string name = kind.form == MetricForm::none           ? "identity_"
                           : kind.form == MetricForm::conservative ? "conservative_"
                                                                   : "expanded_";
  return name + (kind.scheme == Scheme::split ? "split_" : "") + std::to_string(sheet.rows) + "x" +
         std::to_string(sheet.columns);
}

INSTANTIATE_TEST_SUITE_P(MonodomainStep, Step,
                         ::testing::Combine(::testing::ValuesIn(sheets),
                                            ::testing::Values(Kind{MetricForm::none, Scheme::euler},
                                                              Kind{MetricForm::none, Scheme::split},
                                                              Kind{MetricForm::conservative, Scheme::euler},
                                                              Kind{MetricForm::conservative, Scheme::split},
                                                              Kind{MetricForm::expanded, Scheme::euler})),
                         name_of);

TEST(MonodomainStep, UniformSheetIsTheHandCase) {
  const Sheet sheet{3, 5, 1};
  const auto V = test::to_view<double>(3, 5, {Values(15, 0.5)});
  const auto r = test::to_view<double>(3, 5, {Values(15, 1.0)});
  const auto Ta = test::to_view<double>(3, 5, {Values(15, 3.0)});
  const EnsembleField<double, MemorySpace> V_next("V_next", 1, 3, 5);
  tissue::monodomain_step(ExecutionSpace(), tissue::IdentityDiffusion<double, MemorySpace>(sheet.grid()),
                          solver::make_model<double>({}, {}), dt, V, r, Ta, V_next);
  // -8 0.5 0.4 (-0.5) - 0.5 = 0.3;  (0.01 + 0.12/0.8)(-1 - 4 (-0.6)) = 0.16 1.4
  EXPECT_TRUE(all_close(test::to_values(V_next), Values(15, 0.5 + 0.02 * 0.3), 5, {.absolute = 1e-15}));
  EXPECT_TRUE(all_close(test::to_values(r), Values(15, 1 + 0.02 * 0.16 * 1.4), 5, {.absolute = 1e-15}));
  EXPECT_TRUE(
      all_close(test::to_values(Ta), Values(15, 3 + 0.02 * 0.1 * (47.9 * 0.5 - 3)), 5, {.absolute = 1e-14}));
}

// Both precisions, two members: the reference's I_s times dt / C_m is added to each.
class StimulusRegion : public ::testing::Test {
 protected:
  static constexpr int rows = 11, columns = 17;

  template <class Real>
  void expect_current(const solver::Stimulus& stimulus) const {
    solver::Scene scene;
    scene.grid = {rows, columns, 0.6};
    scene.stimuli = {stimulus};
    const auto I_s = reference::stimulus(scene, 0);
    const auto V = test::to_view<Real>(rows, columns, {Values(rows * columns), Values(rows * columns, 1)});
    solver::StimulusSchedule schedule(scene.stimuli, scene.grid, dt);
    const auto active = schedule.active(0);
    ASSERT_EQ(active.size(), 1U);
    tissue::add_stimulus(ExecutionSpace(), V, active.front(), 0.25);
    for (int m = 0; m < 2; ++m) {
      Values expected = I_s;
      for (double& value : expected) value = m + 0.25 * value;
      EXPECT_TRUE(all_close(test::to_values(V, m), expected, columns, {}));
    }
    // and dV/dt holds it too
    const auto r = test::to_view<Real>(rows, columns, {Values(rows * columns)});
    const auto rest = test::to_view<Real>(rows, columns, {Values(rows * columns)});
    const Kokkos::View<tissue::ActiveStimulus*, MemorySpace> list("stimuli", 1);
    Kokkos::deep_copy(list, active.front());
    const tissue::IdentityDiffusion<Real, MemorySpace> diffusion(tissue::Grid{rows, columns, 0.6});
    using Rate = tissue::MonodomainRate<tissue::IdentityDiffusion<Real, MemorySpace>, solver::Model<Real>>;
    const Rate rate{diffusion, solver::make_model<Real>({}, {}), rest, r, list};
    EXPECT_TRUE(all_close(rate_everywhere({rows, columns, 1}, rate), I_s, columns, {}));
  }

  void expect_current_in_both(const solver::Stimulus& stimulus) const {
    expect_current<double>(stimulus);
    expect_current<float>(stimulus);
  }

  static solver::Stimulus disc(double column, double row, double radius) {
    solver::Stimulus s;
    s.amplitude = 0.5;
    s.shape = solver::Stimulus::Shape::disc;
    s.center = {column, row};
    s.radius = radius;
    return s;
  }
};

TEST_F(StimulusRegion, All) {
  solver::Stimulus s;
  s.amplitude = 0.5;
  expect_current_in_both(s);
}

TEST_F(StimulusRegion, Block) {
  solver::Stimulus s;
  s.amplitude = 0.5;
  s.shape = solver::Stimulus::Shape::block;
  s.columns = {3, 16};
  s.rows = {0, 2};
  expect_current_in_both(s);
}

TEST_F(StimulusRegion, Disc) {
  expect_current_in_both(disc(8, 5, 3));  // nodes at exactly the radius are inside
  expect_current_in_both(disc(8.5, 4.25, 2.2));
  expect_current_in_both(disc(4, 5, 0));
}

TEST_F(StimulusRegion, DiscPartlyOrWhollyOffTheSheet) {
  expect_current_in_both(disc(0, 10, 4));
  expect_current_in_both(disc(17.5, -1, 3));
  expect_current_in_both(disc(40, 5, 3));
  expect_current_in_both(disc(5, -20, 3));
}

}  // namespace
}  // namespace myowave
