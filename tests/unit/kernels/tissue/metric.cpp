// The metric of a deformed sheet (kernels/transfer) and the diffusion on it (kernels/tissue).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/tissue/monodomain_step.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "solver/coupling/electromechanics.hpp"
#include "tests/support/allclose.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/reference_excitation.hpp"

namespace myowave {
namespace {

using test::ExecutionSpace;
using test::MemorySpace;
using test::Sheet;
using test::Values;
using testing_support::all_close;

const Sheet sheet{37, 41, 4};

template <class Real>
struct Conservative {
  using Transfer = transfer::ConservativeTransfer<ExecutionSpace, Real>;
  using Diffusion = tissue::ConservativeDiffusion<Real, MemorySpace>;
};

template <class Real>
struct NinePoint {
  static constexpr auto stencil = tissue::Stencil::nine_point;
  using Transfer = transfer::ConservativeTransfer<ExecutionSpace, Real, stencil>;
  using Diffusion = tissue::ConservativeDiffusion<Real, MemorySpace, stencil>;
};

template <class Real>
struct Expanded {
  using Transfer = transfer::ExpandedTransfer<ExecutionSpace, Real>;
  using Diffusion = tissue::ExpandedDiffusion<Real, MemorySpace>;
};

template <class Form>
struct Deformed {
  typename Form::Diffusion diffusion;
  transfer::DeformationBounds bounds;
};

template <class Form>
Deformed<Form> deform(const Sheet& s, const Values& x) {
  const typename Form::Transfer::Metric metric(1, s.grid());
  const typename Form::Transfer transfer(s.grid(), s.elements(), s.cells);
  const auto bounds = transfer.refresh(ExecutionSpace(), test::to_nodes(x), metric, 0);
  return {typename Form::Diffusion(s.grid(), metric), bounds};
}

template <class Diffusion>
Values diffused(const Sheet& s, const Diffusion& diffusion, const Values& V) {
  using Real = typename Diffusion::Scalar;
  const typename Diffusion::ConstView view = test::to_view<Real>(s.rows, s.columns, {V});
  const EnsembleField<Real, MemorySpace> result("diffused", 1, s.rows, s.columns);
  Kokkos::parallel_for(
      "diffused", Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<2>>({0, 0}, {s.rows, s.columns}),
      KOKKOS_LAMBDA(int i, int j) { result(0, i, j) = diffusion.at(view, 0, i, j); });
  return test::to_values(result);
}

// Steps without reactions: V_t = diffusion.
template <class Diffusion>
class Heat {
 public:
  using Real = typename Diffusion::Scalar;
  Heat(const Sheet& s, const Diffusion& diffusion, double dt, const Values& V)
      : diffusion_(diffusion),
        dt_(dt),
        V_(test::to_view<Real>(s.rows, s.columns, {V})),
        V_next_("V_next", 1, s.rows, s.columns),
        r_("r", 1, s.rows, s.columns),
        Ta_("Ta", 1, s.rows, s.columns) {}

  void advance(int steps) {
    solver::ExcitationSettings no_reaction;
    no_reaction.k = 0;
    const auto model = solver::make_model<Real>(no_reaction, {});
    for (int n = 0; n < steps; ++n) {
      tissue::monodomain_step(ExecutionSpace(), diffusion_, model, dt_, V_, r_, Ta_, V_next_);
      std::swap(V_, V_next_);
    }
  }
  Values V() const { return test::to_values(V_); }

 private:
  Diffusion diffusion_;
  double dt_;
  EnsembleField<Real, MemorySpace> V_, V_next_, r_, Ta_;
};

double weighted_sum(const Values& M, const Values& V) {
  double sum = 0;
  for (std::size_t n = 0; n < V.size(); ++n) sum += M[n] * V[n];
  return sum;
}

template <class Form, tissue::Stencil stencil = tissue::Stencil::five_point>
void expect_identity(double tolerance) {
  using Diffusion = typename Form::Diffusion;
  using Real = typename Diffusion::Scalar;
  const Values V = test::random_field(sheet.size(), 0, 1, 1);
  const auto undeformed = deform<Form>(sheet, reference::undeformed(sheet.mesh()));
  const tissue::IdentityDiffusion<Real, MemorySpace, stencil> identity(sheet.grid());
  EXPECT_TRUE(all_close(diffused(sheet, undeformed.diffusion, V), diffused(sheet, identity, V), sheet.columns,
                        {.absolute = tolerance}));
  EXPECT_NEAR(undeformed.bounds.max_trace_inverse_C, 2, 1e-14);
  EXPECT_NEAR(undeformed.bounds.min_J, 1, 1e-14);
}

// Values of up to 8 / dx^2 = 22.
TEST(Metric, OfTheUndeformedSheetIsTheFivePointStencil) {
  expect_identity<Conservative<double>>(2e-13);
  expect_identity<Expanded<double>>(2e-13);
  expect_identity<Conservative<float>>(2e-5);
  expect_identity<Expanded<float>>(2e-5);
}

TEST(Metric, OfTheUndeformedSheetIsTheNinePointStencil) {
  expect_identity<NinePoint<double>, tissue::Stencil::nine_point>(2e-13);
  expect_identity<NinePoint<float>, tissue::Stencil::nine_point>(2e-5);
  EXPECT_NEAR(deform<NinePoint<double>>(sheet, reference::undeformed(sheet.mesh())).bounds.max_stiffness,
              4.0 / 3, 1e-14);
}

template <class Form>
void expect_constants_stay() {
  const auto deformed = deform<Form>(sheet, test::crumpled(sheet.mesh(), 5));
  EXPECT_EQ(diffused(sheet, deformed.diffusion, Values(sheet.size(), 0.7)), Values(sheet.size()));
}

TEST(Metric, ConstantsDoNotDiffuse) {
  expect_constants_stay<Conservative<double>>();
  expect_constants_stay<NinePoint<double>>();
  expect_constants_stay<Expanded<double>>();
  expect_constants_stay<Conservative<float>>();
  expect_constants_stay<Expanded<float>>();
}

double largest_dt(const transfer::DeformationBounds& bounds) {
  solver::Scene scene;
  scene.excitation.k = 0;
  return solver::largest_stable_dt(scene, bounds.max_stiffness);
}

template <class Form>
void expect_weighted_sum_stays() {
  const Values x = test::crumpled(sheet.mesh(), 6),
               M = reference::node_weights(sheet.reference_grid(), sheet.mesh(), x);
  const auto deformed = deform<Form>(sheet, x);
  ASSERT_GT(deformed.bounds.min_J, 0.2);
  const Values V = test::random_field(sheet.size(), 0, 1, 7);
  Heat heat(sheet, deformed.diffusion, 0.9 * largest_dt(deformed.bounds), V);
  heat.advance(1000);
  const Values V_end = heat.V();
  const double before = weighted_sum(M, V), after = weighted_sum(M, V_end);
  ::testing::Test::RecordProperty("relative_drift", std::to_string(1e15 * (after / before - 1)) + "e-15");
  EXPECT_NEAR(after / before, 1, 1e-12);
  // and it has diffused: most of the difference between the nodes is gone
  EXPECT_LT(*std::max_element(V_end.begin(), V_end.end()), 0.8);
}

TEST(Metric, ConservativeFormConservesTheWeightedSum) { expect_weighted_sum_stays<Conservative<double>>(); }
TEST(Metric, NinePointFormConservesTheWeightedSum) { expect_weighted_sum_stays<NinePoint<double>>(); }

template <class Form>
void expect_energy_loss_up_to_the_bound() {
  const Values x = test::crumpled(sheet.mesh(), 8),
               M = reference::node_weights(sheet.reference_grid(), sheet.mesh(), x);
  const auto deformed = deform<Form>(sheet, x);
  // The two energies that decay: sum M V^2, and sum of the cell energies = -1/2 sum M V V_t.
  const auto energies = [&](const Values& V) {
    const Values rate = diffused(sheet, deformed.diffusion, V);
    std::array<double, 2> energy{};
    for (int n = 0; n < sheet.size(); ++n) {
      energy[0] += M[n] * V[n] * V[n];
      energy[1] -= M[n] * V[n] * rate[n] / 2;
    }
    return energy;
  };
  Heat heat(sheet, deformed.diffusion, largest_dt(deformed.bounds),
            test::random_field(sheet.size(), -1, 1, 9));
  auto energy = energies(heat.V());
  for (int n = 0; n < 200; ++n) {
    heat.advance(1);
    const auto next = energies(heat.V());
    ASSERT_LT(next[0], energy[0]) << "step " << n;
    ASSERT_LT(next[1], energy[1]) << "step " << n;
    energy = next;
  }
}

TEST(Metric, ConservativeFormLosesEnergyUpToTheStabilityBound) {
  expect_energy_loss_up_to_the_bound<Conservative<double>>();
}
TEST(Metric, NinePointFormLosesEnergyUpToItsStabilityBound) {
  expect_energy_loss_up_to_the_bound<NinePoint<double>>();
}

template <class Form>
void expect_bounds() {
  const Values x = test::crumpled(sheet.mesh(), 10);
  double largest_trace = 0, smallest_J = 1e300;
  for (int i = 0; i < sheet.rows - 1; ++i)
    for (int j = 0; j < sheet.columns - 1; ++j) {
      const auto F = reference::deformation_gradient(sheet.mesh(), x, i / sheet.cells, j / sheet.cells,
                                                     (j % sheet.cells + 0.5) / sheet.cells,
                                                     (i % sheet.cells + 0.5) / sheet.cells);
      const auto f = reference::inverse(F);
      double trace = 0;
      for (const auto& row : f)
        for (const double entry : row) trace += entry * entry;
      largest_trace = std::max(largest_trace, trace);
      smallest_J = std::min(smallest_J, reference::determinant(F));
    }
  const auto bounds = deform<Form>(sheet, x).bounds;
  EXPECT_NEAR(bounds.max_trace_inverse_C, largest_trace, 1e-12);
  EXPECT_NEAR(bounds.min_J, smallest_J, 1e-13);
}

TEST(Metric, BoundsAreThoseOfALoopOverTheCells) {
  expect_bounds<Conservative<double>>();
  expect_bounds<Conservative<float>>();
  expect_bounds<Expanded<double>>();
}

TEST(Metric, BoundsSeeAnInvertedCell) {
  Values x = reference::undeformed(sheet.mesh());
  const int n = sheet.mesh().node(4, 5);
  x[2 * n] += 1.6 * sheet.mesh().h;  // past its right neighbour
  EXPECT_LT(deform<Conservative<double>>(sheet, x).bounds.min_J, 0);
  EXPECT_LT(deform<Expanded<double>>(sheet, x).bounds.min_J, 0);
}

// g = C^-1 and b^N = 2 g^12 (F^-1)^N_k x_k,12 of x = F X + X1 X2 c against the kernel's nodes.
void expect_expanded_metric(const reference::Tensor& A, const std::array<double, 2>& c) {
  const Values x = test::mapped(sheet.mesh(), [&](double X1, double X2) {
    return std::array{A[0][0] * X1 + A[0][1] * X2 + c[0] * X1 * X2,
                      A[1][0] * X1 + A[1][1] * X2 + c[1] * X1 * X2};
  });
  const auto metric = deform<Expanded<double>>(sheet, x).diffusion.metric;
  std::array<Values, 5> expected;
  for (int i = 0; i < sheet.rows; ++i)
    for (int j = 0; j < sheet.columns; ++j) {
      const double X1 = j * sheet.dx, X2 = i * sheet.dx;
      const auto f = reference::inverse(
          {{{A[0][0] + c[0] * X2, A[0][1] + c[0] * X1}, {A[1][0] + c[1] * X2, A[1][1] + c[1] * X1}}});
      const double g12 = f[0][0] * f[1][0] + f[0][1] * f[1][1];
      expected[0].push_back(f[0][0] * f[0][0] + f[0][1] * f[0][1]);
      expected[1].push_back(g12);
      expected[2].push_back(f[1][0] * f[1][0] + f[1][1] * f[1][1]);
      expected[3].push_back(2 * g12 * (f[0][0] * c[0] + f[0][1] * c[1]));
      expected[4].push_back(2 * g12 * (f[1][0] * c[0] + f[1][1] * c[1]));
    }
  const std::array fields{metric.g11, metric.g12, metric.g22, metric.b1, metric.b2};
  for (int n = 0; n < 5; ++n)
    EXPECT_TRUE(all_close(test::to_values(fields[n]), expected[n], sheet.columns, {.absolute = 1e-12})) << n;
}

TEST(Metric, ExpandedFormOfAnAffineMap) { expect_expanded_metric({{{1.2, 0.3}, {-0.1, 0.8}}}, {0, 0}); }

TEST(Metric, ExpandedFormOfABilinearMapHasItsChristoffelSymbols) {
  expect_expanded_metric({{{1.2, 0.3}, {-0.1, 0.8}}}, {0.01, -0.008});
}

}  // namespace
}  // namespace myowave
