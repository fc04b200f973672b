// Schemes for Eqs 22a, b on a plane wave, as plain loops: how far off they are for how many looks at the
// neighbours. `--gtest_filter=*Table*` prints what solver/README.md shows.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "kernels/cell/aliev_panfilov.hpp"

namespace myowave {
namespace {

using Values = std::vector<double>;

const cell::AlievPanfilov<double> model;

// The velocity of the plane wave in the limit of small steps (split at dx = 0.15 and 0.1; solver/README.md).
constexpr double true_velocity = 1.589;

// A wave along the rows of a grid, or along its diagonal, where lines of equal V are half a diagonal apart.
enum class Along { row, diagonal };
enum class Points { five, nine };

struct Line {
  double dx;
  Along along;
  Points points;

  double spacing() const { return along == Along::row ? dx : dx / std::sqrt(2.0); }

  Values laplacian(const Values& V) const {
    const int n = static_cast<int>(V.size());
    const auto at = [&](int j) { return V[j < 0 ? -j : (j < n ? j : 2 * (n - 1) - j)]; };
    Values result(n);
    for (int j = 0; j < n; ++j) {
      const double near = at(j - 1) + at(j + 1) - 2 * V[j], far = at(j - 2) + at(j + 2) - 2 * V[j];
      // Along a row both stencils are the same three points. Across the lines of a diagonal two neighbours
      // lie at either side of a node, and of nine points one more beyond them.
      const double sum = along == Along::row      ? near
                         : points == Points::five ? 2 * near
                                                  : (8 * near + far) / 6;
      result[j] = sum / (dx * dx);
    }
    return result;
  }
};

struct State {
  Values V, r;
};

State rate(const Line& line, const State& s) {
  State result{line.laplacian(s.V), Values(s.V.size())};
  for (std::size_t j = 0; j < s.V.size(); ++j) {
    result.V[j] += model.excitation(s.V[j], s.r[j]);
    result.r[j] = model.recovery(s.V[j], s.r[j]);
  }
  return result;
}

// a + h b
State plus(const State& a, double h, const State& b) {
  State result = a;
  for (std::size_t j = 0; j < a.V.size(); ++j) result.V[j] += h * b.V[j], result.r[j] += h * b.r[j];
  return result;
}

using Step = std::function<void(const Line&, double dt, State&)>;

void euler(const Line& line, double dt, State& s) { s = plus(s, dt, rate(line, s)); }

// V as Euler's, r to second order at its V.
void euler_with_gates(const Line& line, double dt, State& s) {
  const State old = s;
  euler(line, dt, s);
  for (std::size_t j = 0; j < s.V.size(); ++j) s.r[j] = model.recovered(old.V[j], old.r[j], dt);
}

void heun(const Line& line, double dt, State& s) {
  const State first = rate(line, s);
  s = plus(plus(s, dt / 2, first), dt / 2, rate(line, plus(s, dt, first)));
}

// Of second order, with four stages (Verwer, Hundsdorfer & Sommeijer 1990), damping 2 / 13.
void chebyshev(const Line& line, double dt, State& s) {
  constexpr int stages = 4;
  constexpr double w0 = 1 + 2.0 / 13 / (stages * stages);
  std::array<double, stages + 1> T{1, w0}, T1{0, 1}, T2{0, 0}, b{};
  for (int n = 2; n <= stages; ++n) {
    T[n] = 2 * w0 * T[n - 1] - T[n - 2];
    T1[n] = 2 * T[n - 1] + 2 * w0 * T1[n - 1] - T1[n - 2];
    T2[n] = 4 * T1[n - 1] + 2 * w0 * T2[n - 1] - T2[n - 2];
  }
  for (int n = 2; n <= stages; ++n) b[n] = T2[n] / (T1[n] * T1[n]);
  b[0] = b[1] = b[2];
  const double w1 = T1[stages] / T2[stages];
  const State start = s, first = rate(line, s);
  State before = s, now = plus(s, b[1] * w1 * dt, first);
  for (int n = 2; n <= stages; ++n) {
    const double mu = 2 * b[n] * w0 / b[n - 1], nu = -b[n] / b[n - 2], mu_t = 2 * b[n] * w1 / b[n - 1];
    const double gamma = -(1 - b[n - 1] * T[n - 1]) * mu_t;
    State next = plus(plus(start, -1, start), 1 - mu - nu, start);
    next = plus(plus(next, mu, now), nu, before);
    next = plus(plus(next, mu_t * dt, rate(line, now)), gamma * dt, first);
    before = std::move(now);
    now = std::move(next);
  }
  s = now;
}

// V by the explicit midpoint rule.
void explicit_split(const Line& line, double dt, State& s) {
  const Values diffused = line.laplacian(s.V);
  for (std::size_t j = 0; j < s.V.size(); ++j) {
    const double V = s.V[j] + dt * diffused[j], r = s.r[j];
    const double middle = V + dt / 2 * model.excitation(V, r);
    s.r[j] = model.recovered(middle, r, dt);
    s.V[j] = V + dt * model.excitation(middle, (r + s.r[j]) / 2);
  }
}

// tissue::SplitStep
void split(const Line& line, double dt, State& s) {
  const Values diffused = line.laplacian(s.V);
  for (std::size_t j = 0; j < s.V.size(); ++j) {
    const double V = s.V[j] + dt * diffused[j], r = s.r[j];
    const double middle = V + dt / 2 * model.excitation(V, r) / (1 - dt / 2 * model.excitation_by_V(V, r));
    s.r[j] = model.recovered(middle, r, dt);
    s.V[j] = 2 * middle - V + dt / 2 * (s.r[j] - r) * model.excitation_by_r(middle);
  }
}

struct Wave {
  double velocity = std::numeric_limits<double>::quiet_NaN();  // length units / t.u.
  double apd = std::numeric_limits<double>::quiet_NaN();       // t.u., V > 0.1
};

// On a line of length 120, V = 1 on x <= 3: the velocity between its thirds at V = 0.5, APD in the middle.
Wave wave(const Step& step, const Line& line, double dt) {
  const double h = line.spacing();
  const int n = static_cast<int>(std::lround(120 / h)) + 1, near = n / 3, far = 2 * n / 3, middle = n / 2;
  State s{Values(n), Values(n)};
  for (int j = 0; j * h <= 3 + 1e-9; ++j) s.V[j] = 1;
  double at_near = -1, at_far = -1, up = -1, down = -1;
  for (int k = 0; k * dt < 150 && down < 0; ++k) {
    const State old = s;
    step(line, dt, s);
    if (!std::isfinite(s.V[middle])) return {};
    const auto crosses = [&](int j, double level, double& at) {
      if (at < 0 && (old.V[j] < level) != (s.V[j] < level))
        at = dt * (k + (level - old.V[j]) / (s.V[j] - old.V[j]));
    };
    crosses(near, 0.5, at_near), crosses(far, 0.5, at_far);
    if (up >= 0) crosses(middle, 0.1, down);
    crosses(middle, 0.1, up);
  }
  return {(far - near) * h / (at_far - at_near), down - up};
}

struct Scheme {
  std::string name;
  Step step;
  Points points;
  int looks;  // stencil evaluations in a step
};

const Scheme eulers{"Euler", euler, Points::five, 1}, splits{"split", split, Points::nine, 1},
    five_point_split{"split, five points", split, Points::five, 1};

double error(const Scheme& scheme, double dt, double dx, Along along) {
  return wave(scheme.step, {dx, along, scheme.points}, dt).velocity / true_velocity - 1;
}

TEST(PlaneWave, Table) {
  const Scheme gates{"Euler, r of second order", euler_with_gates, Points::five, 1};
  const Scheme nine_point_euler{"Euler, nine points", euler, Points::nine, 1};
  const Scheme explicits{"split, explicit", explicit_split, Points::nine, 1};
  const Scheme heuns{"Heun", heun, Points::five, 2}, chebyshevs{"RKC, 4 stages", chebyshev, Points::five, 4};
  struct Row {
    const Scheme& scheme;
    double dt, dx;
  };
  const std::array rows{
      Row{eulers, 0.02, 0.6},    Row{eulers, 0.04, 0.6},           Row{eulers, 0.005, 0.3},
      Row{gates, 0.02, 0.6},     Row{nine_point_euler, 0.02, 0.6}, Row{heuns, 0.04, 0.6},
      Row{heuns, 0.06, 0.6},     Row{chebyshevs, 0.12, 0.6},       Row{five_point_split, 0.06, 0.6},
      Row{explicits, 0.06, 0.6}, Row{splits, 0.02, 0.6},           Row{splits, 0.06, 0.6},
      Row{splits, 0.1, 0.6},     Row{splits, 0.1, 0.75},           Row{splits, 0.1, 0.8},
      Row{splits, 0.15, 1},      Row{splits, 0.2, 1.15},           Row{splits, 0.015, 0.3}};
  std::printf(
      "| scheme | dx | dt | looks / t.u. | velocity, row | diagonal | APD "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const auto& [scheme, dt, dx] : rows) {
    const Wave row = wave(scheme.step, {dx, Along::row, scheme.points}, dt);
    const double diagonal = error(scheme, dt, dx, Along::diagonal);
    std::printf("| %s | %g | %g | %.3g | %+.2f %% | %+.2f %% | %.2f |\n", scheme.name.c_str(), dx, dt,
                scheme.looks / dt, 100 * (row.velocity / true_velocity - 1), 100 * diagonal, row.apd);
    EXPECT_NEAR(row.apd, 36.73, 0.15) << scheme.name;
  }
}

TEST(PlaneWave, SplitStepsAreCloserThanEulersInEveryDirection) {
  for (const Along along : {Along::row, Along::diagonal}) {
    EXPECT_LT(std::abs(error(splits, 0.06, 0.6, along)), 0.002);
    EXPECT_LT(std::abs(error(splits, 0.1, 0.8, along)), 0.002);
    EXPECT_LT(std::abs(error(splits, 0.2, 1.15, along)), 0.01);
    EXPECT_GT(std::abs(error(eulers, 0.02, 0.6, along)), 0.02);
  }
  // Five points leave an error dx^2 / 6 V_xxyy, which acts along a diagonal.
  EXPECT_GT(error(five_point_split, 0.06, 0.6, Along::diagonal), 0.008);
}

// Twice the grid spacing and four times the step: 16 times the error at fourth order, less the error of the
// finest grid.
TEST(PlaneWave, SplitStepIsOfFourthOrderInTheSpacing) {
  const auto velocity = [](double dx) {
    return wave(split, {dx, Along::row, Points::nine}, dx * dx / 6).velocity;
  };
  const double coarse = velocity(1.2), usual = velocity(0.6), fine = velocity(0.3);
  const double order = std::log2((usual - coarse) / (fine - usual));
  EXPECT_GT(order, 3.4);
  EXPECT_LT(order, 4.6);
}

}  // namespace
}  // namespace myowave
