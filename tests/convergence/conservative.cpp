// Observed order of diffusion on a deformed sheet: V_t = div grad V in deformed coordinates against exact
// solutions, elements and grid refined together, dt ~ dx^2. This is the order of the solution. The error of
// the operator itself is larger at the lines between elements.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "kernels/tissue/monodomain_step.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "solver/coupling/select_form.hpp"
#include "solver/excitation/select_model.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/reference_excitation.hpp"

namespace myowave {
namespace {

using solver::MetricForm;
using std::numbers::pi;
using test::ExecutionSpace;
using test::Map;
using test::MemorySpace;
using test::Sheet;
using test::Values;

constexpr double side = 1;  // of the undeformed sheet

// u(x1, x2, t)
using Solution = std::function<double(double, double, double)>;

// Deformed positions of the grid nodes, which lie on the bilinear elements.
std::vector<std::array<double, 2>> grid_positions(const Sheet& sheet, const Values& x) {
  const auto mesh = sheet.mesh();
  std::vector<std::array<double, 2>> positions;
  for (int i = 0; i < sheet.rows; ++i)
    for (int j = 0; j < sheet.columns; ++j) {
      const int I = std::min(i / sheet.cells, mesh.rows - 1), J = std::min(j / sheet.cells, mesh.columns - 1);
      const double t = double(i - I * sheet.cells) / sheet.cells,
                   s = double(j - J * sheet.cells) / sheet.cells;
      std::array<double, 2> p{};
      for (int k = 0; k < 2; ++k)
        p[k] = (1 - t) * ((1 - s) * x[2 * mesh.node(I, J) + k] + s * x[2 * mesh.node(I, J + 1) + k]) +
               t * ((1 - s) * x[2 * mesh.node(I + 1, J) + k] + s * x[2 * mesh.node(I + 1, J + 1) + k]);
      positions.push_back(p);
    }
  return positions;
}

// Relative L2 error, over the deformed sheet, at t_end with `cells` grid cells along each side.
double error_of(MetricForm form, const Map& map, const Solution& u, double t_end, int cells) {
  const Sheet sheet{cells + 1, cells + 1, 4, side / cells};
  const Values x = test::mapped(sheet.mesh(), map);
  const auto positions = grid_positions(sheet, x);
  const auto sampled = [&](double t) {
    Values values;
    for (const auto& [x1, x2] : positions) values.push_back(u(x1, x2, t));
    return values;
  };

  const ExecutionSpace space;
  const auto steps = static_cast<int>(std::ceil(t_end / (0.05 * sheet.dx * sheet.dx)));
  auto V = test::to_view<double>(sheet.rows, sheet.columns, {sampled(0)});
  EnsembleField<double, MemorySpace> V_next("V_next", 1, sheet.rows, sheet.columns);
  const EnsembleField<double, MemorySpace> r("r", 1, sheet.rows, sheet.columns);
  const EnsembleField<double, MemorySpace> Ta("Ta", 1, sheet.rows, sheet.columns);
  solver::ExcitationSettings no_reaction;
  no_reaction.k = 0;
  const auto model = solver::make_model<double>(no_reaction, {});
  const auto selected =
      solver::select_form<ExecutionSpace, double>(form, sheet.grid(), sheet.elements(), sheet.cells);
  std::visit(
      [&](const auto& f) {
        if constexpr (requires { f.transfer; })
          f.transfer.refresh(space, test::to_nodes(x), f.diffusion.metric, 0);
        for (int n = 0; n < steps; ++n) {
          tissue::monodomain_step(space, f.diffusion, model, t_end / steps, V, r, Ta, V_next);
          std::swap(V, V_next);
        }
      },
      selected);

  const Values actual = test::to_values(V), exact = sampled(t_end);
  const Values M = reference::node_weights(sheet.reference_grid(), sheet.mesh(), x);
  double error = 0, norm = 0;
  for (std::size_t n = 0; n < exact.size(); ++n) {
    error += M[n] * (actual[n] - exact[n]) * (actual[n] - exact[n]);
    norm += M[n] * exact[n] * exact[n];
  }
  return std::sqrt(error / norm);
}

// Errors with 16, 32 and 64 cells along a side, and the observed orders.
struct Refinement {
  double coarse, middle, fine;
  double first_order() const { return std::log2(coarse / middle); }
  double second_order() const { return std::log2(middle / fine); }
};

Refinement refine(MetricForm form, const Map& map, const Solution& u, double t_end) {
  const Refinement errors{error_of(form, map, u, t_end, 16), error_of(form, map, u, t_end, 32),
                          error_of(form, map, u, t_end, 64)};
  ::testing::Test::RecordProperty(
      "orders", std::to_string(errors.first_order()) + " " + std::to_string(errors.second_order()));
  ::testing::Test::RecordProperty("errors", std::to_string(errors.coarse) + " " +
                                                std::to_string(errors.middle) + " " +
                                                std::to_string(errors.fine));
  return errors;
}

// A general smooth map of the square onto a turned rectangle a x b: both coordinates are bent inside
// and along the edges, which stay straight, so that the rectangle's modes are exact solutions with
// no flux.
constexpr double a = 1.2, b = 0.85, turn = 0.5;

std::array<double, 2> bent(double X1, double X2) {
  const double y1 = X1 + 0.05 * std::sin(pi * X1) * (1 + std::cos(1.3 * pi * X2 + 0.4));
  const double y2 = X2 + 0.06 * std::sin(pi * X2) * (std::cos(1.1 * pi * X1) - 0.5 * X1);
  const double c = std::cos(turn), s = std::sin(turn);
  return {c * a * y1 - s * b * y2, s * a * y1 + c * b * y2};
}

double mode(double x1, double x2, double t) {
  const double c = std::cos(turn), s = std::sin(turn);
  const double y1 = c * x1 + s * x2, y2 = -s * x1 + c * x2;  // along the rectangle's edges
  const double k1 = pi / a, k2 = 2 * pi / b;
  return std::exp(-(k1 * k1 + k2 * k2) * t) * std::cos(k1 * y1) * std::cos(k2 * y2) +
         0.5 * std::exp(-4 * k1 * k1 * t) * std::cos(2 * k1 * y1);
}

// A bilinear map, which every mesh represents exactly, of the square onto a general quadrilateral.
std::array<double, 2> quadrilateral(double X1, double X2) {
  return {1.2 * X1 + 0.3 * X2 + 0.25 * X1 * X2, -0.2 * X1 + 0.9 * X2 + 0.2 * X1 * X2};
}

// A spreading Gaussian, so narrow that it does not reach an edge.
double spot(double x1, double x2, double t) {
  const auto [c1, c2] = quadrilateral(0.47, 0.52);
  const double width2 = 0.012 + 4 * t;
  return 0.012 / width2 * std::exp(-((x1 - c1) * (x1 - c1) + (x2 - c2) * (x2 - c2)) / width2);
}

TEST(Convergence, ConservativeFormIsOfSecondOrderOnAGeneralMap) {
  const Refinement errors = refine(MetricForm::conservative, bent, mode, 0.02);
  EXPECT_NEAR(errors.first_order(), 2, 0.2);
  EXPECT_NEAR(errors.second_order(), 2, 0.2);
  EXPECT_LT(errors.fine, 1e-3);
}

TEST(Convergence, ConservativeFormIsOfSecondOrderOnABilinearMap) {
  const Refinement errors = refine(MetricForm::conservative, quadrilateral, spot, 0.002);
  EXPECT_NEAR(errors.first_order(), 2, 0.2);
  EXPECT_NEAR(errors.second_order(), 2, 0.2);
  EXPECT_LT(errors.fine, 2e-3);
}

TEST(Convergence, ExpandedFormIsOfSecondOrderOnABilinearMap) {
  const Refinement errors = refine(MetricForm::expanded, quadrilateral, spot, 0.002);
  EXPECT_NEAR(errors.first_order(), 2, 0.2);
  EXPECT_NEAR(errors.second_order(), 2, 0.2);
  EXPECT_LT(errors.fine, 2e-3);
}

// x_,11 and x_,22 are in the jumps of F between elements, which this form ignores.
TEST(Convergence, ExpandedFormDoesNotConvergeOnAGeneralMap) {
  const Refinement errors = refine(MetricForm::expanded, bent, mode, 0.02);
  EXPECT_LT(std::abs(errors.second_order()), 0.2);
  EXPECT_GT(errors.fine, 0.05);
}

}  // namespace
}  // namespace myowave
