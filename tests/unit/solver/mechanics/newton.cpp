// Newton's globalisation on potentials of one unknown, by hand.
#include "solver/mechanics/newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace myowave::solver {
namespace {

// Pi(x) with first and second derivative, admissible for x > 0; L = 1.
struct Toy {
  std::function<double(double)> energy, slope, curvature;
  double x = 1, tried = 0, direction = 0;
  std::vector<double> R{0}, K{0};
  int evaluations = 0;

  Evaluation at(double position) {
    ++evaluations;
    return {.energy = energy(position), .min_J = position};
  }
  Evaluation evaluate() { return at(x); }
  void linearize() {
    R[0] = slope(x);
    K[0] = curvature(x);
  }
  std::span<const double> residual() const { return R; }
  std::span<const double> tangent(double shift) {
    shifted[0] = K[0] + shift;
    return shifted;
  }
  void set_direction(std::span<const double> d) { direction = d[0]; }
  Evaluation move(double length) { return at(tried = x + length * direction); }
  void accept() { x = tried; }

  std::vector<double> shifted{0};
};

NewtonReport minimise(Toy& toy, NewtonSettings settings = {}) {
  DirectSolver solver(std::vector<int>{0, 1}, std::vector<int>{0});
  return Newton(toy, solver, settings).minimise();
}

TEST(Newton, ReachesAQuadraticMinimumInOneStep) {
  Toy toy{.energy = [](double x) { return (x - 3) * (x - 3); },
          .slope = [](double x) { return 2 * (x - 3); },
          .curvature = [](double) { return 2; }};
  const auto report = minimise(toy);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.shifts, 0);
  EXPECT_DOUBLE_EQ(toy.x, 3);
}

// x - ln x: from 4 the full step goes to 4 - 4^2 (3/4) = -8, half of it to -2, a quarter to 1.
TEST(Newton, HalvesAStepThatIsNotAdmissible) {
  Toy toy{.energy = [](double x) { return x - std::log(x); },
          .slope = [](double x) { return 1 - 1 / x; },
          .curvature = [](double x) { return 1 / (x * x); },
          .x = 4};
  const auto report = minimise(toy);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.halvings, 2);
  EXPECT_DOUBLE_EQ(toy.x, 1);
}

// x^4/4 - x^2/2 has its minimum at 1 and negative curvature below 1/sqrt 3: plain Newton from 0.3
// would go to the maximum at 0.
TEST(Newton, ShiftsANegativeCurvature) {
  Toy toy{.energy = [](double x) { return x * x * (x * x - 2) / 4; },
          .slope = [](double x) { return x * x * x - x; },
          .curvature = [](double x) { return 3 * x * x - 1; },
          .x = 0.3};
  const auto report = minimise(toy);
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.shifts, 0);
  EXPECT_EQ(report.largest_shift, 4);
  EXPECT_NEAR(toy.x, 1, 1e-8);
}

TEST(Newton, APotentialWithoutMinimumIsGivenUp) {
  Toy toy{.energy = [](double x) { return -std::log(x); },
          .slope = [](double x) { return -1 / x; },
          .curvature = [](double x) { return 1 / (x * x); }};
  const auto report = minimise(toy, {.tolerance = 1e-30});
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 60);
}

// The slope is wrong: no step length decreases Pi. The shift grows until the step is below rounding, and the
// attempts are counted.
TEST(Newton, AStepThatIsNeverAcceptedIsGivenUp) {
  Toy toy{.energy = [](double x) { return x; },
          .slope = [](double) { return -1; },
          .curvature = [](double) { return 1; }};
  const auto report = minimise(toy, {.energy_noise = 0});
  EXPECT_FALSE(report.converged);
  EXPECT_LE(report.factorizations, 120);
  EXPECT_NEAR(toy.x, 1, 1e-12);
}

// Near the minimum of 1e9 + (x - 1)^2 the decrease is below the rounding of Pi.
TEST(Newton, RoundingOfTheEnergyDoesNotStopTheLastSteps) {
  Toy toy{.energy = [](double x) { return 1e9 + (x - 1) * (x - 1); },
          .slope = [](double x) { return 2 * (x - 1); },
          .curvature = [](double) { return 2; },
          .x = 1 + 1e-6};
  const auto report = minimise(toy, {.tolerance = 1e-12});
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
}

// (x - c)^2 / 2 + x^4 / 4 with c moved: the factor of the old minimum gives the first step.
TEST(Newton, StartsWithTheFactorOfTheLastMinimum) {
  double c = 2;
  Toy toy{.energy = [&](double x) { return (x - c) * (x - c) / 2 + x * x * x * x / 4; },
          .slope = [&](double x) { return x - c + x * x * x; },
          .curvature = [](double x) { return 1 + 3 * x * x; },
          .x = 1.5};
  DirectSolver solver(std::vector<int>{0, 1}, std::vector<int>{0});
  ASSERT_TRUE(Newton(toy, solver, NewtonSettings{}).minimise().converged);
  EXPECT_NEAR(toy.x, 1, 1e-8);
  c = 2.1;
  const auto report = Newton(toy, solver, NewtonSettings{}).minimise(true);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.factorizations, report.iterations - 1);
  EXPECT_NEAR(toy.x - c + toy.x * toy.x * toy.x, 0, 1e-8);
}

// Pi = x.B x / 2 + sum x_k^4 / 4 close to its saddle at 0: the diagonal of K is 3 x_k^2, far below the other
// entries, and a factorisation without pivoting has no correct digit.
struct NearSaddle {
  static constexpr int n = 9;
  std::vector<double> x = std::vector<double>(n), tried = x, direction = x, R = x, B, K;

  NearSaddle() {
    for (int i = 0; i < n; ++i) {
      x[i] = 1e-7 * std::cos(i);
      for (int j = 0; j < i; ++j) B.push_back(std::sin(3.0 * i + 7.0 * j));
      B.push_back(0);
    }
  }
  // Calls visit(i, j, slot) for the lower triangle.
  template <class Visit>
  static void for_each_entry(const Visit& visit) {
    for (int i = 0, slot = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j, ++slot) visit(i, j, slot);
  }
  static std::vector<double> product(const std::vector<double>& A, const std::vector<double>& v) {
    std::vector<double> result(n);
    for_each_entry([&](int i, int j, int slot) {
      result[i] += A[slot] * v[j];
      if (i != j) result[j] += A[slot] * v[i];
    });
    return result;
  }
  Evaluation at(const std::vector<double>& y) const {
    const auto By = product(B, y);
    double energy = 0;
    for (int i = 0; i < n; ++i) energy += y[i] * By[i] / 2 + std::pow(y[i], 4) / 4;
    return {.energy = energy, .min_J = 1};
  }
  Evaluation evaluate() const { return at(x); }
  void linearize() {
    R = product(B, x);
    for (int i = 0; i < n; ++i) R[i] += std::pow(x[i], 3);
  }
  std::span<const double> residual() const { return R; }
  std::span<const double> tangent(double shift) {
    K = B;
    for_each_entry([&](int i, int j, int slot) { K[slot] += i == j ? 3 * x[i] * x[i] + shift : 0; });
    return K;
  }
  void set_direction(std::span<const double> d) {
    direction.assign(d.begin(), d.end());
    const auto Kd = product(K, direction);
    double wrong = 0, size = 0;
    for (int i = 0; i < n; ++i) {
      wrong += std::abs(Kd[i] + R[i]);
      size += std::abs(d[i]) + std::abs(R[i]);
    }
    EXPECT_LT(wrong, 2e-10 * size);
  }
  Evaluation move(double length) {
    for (int i = 0; i < n; ++i) tried[i] = x[i] + length * direction[i];
    return at(tried);
  }
  void accept() { x = tried; }
};

TEST(Newton, FollowsNoDirectionThatDoesNotSolveItsSystem) {
  NearSaddle saddle;
  std::vector<int> row_begin{0}, column;
  NearSaddle::for_each_entry([&](int i, int j, int) {
    column.push_back(j);
    if (i == j) row_begin.push_back(static_cast<int>(column.size()));
  });
  DirectSolver solver(row_begin, column);
  const auto report = Newton(saddle, solver, {.tolerance = 1e-12, .near_solution = 1e-9}).minimise();
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.shifts, 0);
  EXPECT_LT(report.energy, -1);
}

// The factor of a maximum leads uphill and is not used.
TEST(Newton, AFactorThatLeadsUphillIsNotUsed) {
  Toy toy{.energy = [](double x) { return (x - 3) * (x - 3); },
          .slope = [](double x) { return 2 * (x - 3); },
          .curvature = [](double) { return 2; }};
  DirectSolver solver(std::vector<int>{0, 1}, std::vector<int>{0});
  solver.factorize(std::vector<double>{-1});
  const auto report = Newton(toy, solver, NewtonSettings{}).minimise(true);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.factorizations, 1);
  EXPECT_DOUBLE_EQ(toy.x, 3);
}

TEST(Newton, NotANumberIsGivenUpAtOnce) {
  Toy toy{.energy = [](double) { return std::nan(""); },
          .slope = [](double) { return 0; },
          .curvature = [](double) { return 1; }};
  EXPECT_FALSE(minimise(toy).converged);
  Toy residual{.energy = [](double) { return 0; },
               .slope = [](double) { return std::nan(""); },
               .curvature = [](double) { return 1; }};
  EXPECT_FALSE(minimise(residual).converged);
}

}  // namespace
}  // namespace myowave::solver
