// A field and an initial state on another grid of the same sheet.
#include "apps/input/resample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/input/initial_state.hpp"

namespace myowave::apps {
namespace {

using solver::GridSettings;

template <class Function>
std::vector<double> field(const GridSettings& grid, const Function& function) {
  std::vector<double> values;
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) values.push_back(function(j * grid.dx, i * grid.dx));
  return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, std::abs(a[n] - b[n]));
  return largest;
}

// 9 x 12 length units
const GridSettings coarse{.rows = 13, .columns = 17, .dx = 0.75}, fine{.rows = 19, .columns = 25, .dx = 0.5};

TEST(Resample, CubicsStayWhatTheyAre) {
  // Monotone, so that each value lies within its sixteen.
  const auto cubic = [](double x, double y) { return 1 + x + 0.3 * x * x * x + (2 + x) * (y * y * y + y); };
  for (const auto& [from, to] : {std::pair(coarse, fine), std::pair(fine, coarse)}) {
    const auto made = resample(field(from, cubic), from, to), wanted = field(to, cubic);
    ASSERT_EQ(made.size(), wanted.size());
    for (std::size_t n = 0; n < made.size(); ++n) EXPECT_NEAR(made[n], wanted[n], 1e-12 * wanted[n]);
  }
}

TEST(Resample, ErrorsAreOfFourthOrder) {
  const auto rise = [](double x, double y) { return std::exp(x / 3 + y / 2); };
  const auto error = [&](int refined) {
    const GridSettings from{.rows = 12 * refined + 1, .columns = 16 * refined + 1, .dx = 0.75 / refined};
    const GridSettings to{.rows = 24 * refined + 1, .columns = 32 * refined + 1, .dx = 0.375 / refined};
    return largest_difference(resample(field(from, rise), from, to), field(to, rise));
  };
  EXPECT_GT(std::log2(error(4) / error(8)), 3.7);
}

TEST(Resample, CommonNodesKeepTheirBits) {
  const auto wave = [](double x, double y) { return std::sin(x) * std::cos(y); };
  const auto values = field(coarse, wave);
  EXPECT_EQ(resample(values, coarse, coarse), values);
  const auto made = resample(values, coarse, fine);
  for (int i = 0; i < fine.rows; i += 3)
    for (int j = 0; j < fine.columns; j += 3)
      EXPECT_EQ(made[i * fine.columns + j], values[i / 3 * 2 * coarse.columns + j / 3 * 2]);
}

TEST(Resample, AFrontStaysWithinItsRange) {
  const auto made = resample(field(coarse, [](double x, double) { return x < 5 ? 1.0 : 0.0; }), coarse, fine);
  const auto [low, high] = std::ranges::minmax(made);
  EXPECT_EQ(low, 0);
  EXPECT_EQ(high, 1);
}

TEST(Resample, SheetsOfFewNodesAreLines) {
  const GridSettings two{.rows = 2, .columns = 2, .dx = 1}, three{.rows = 3, .columns = 3, .dx = 0.5};
  EXPECT_EQ(resample(std::vector{0.0, 1.0, 2.0, 3.0}, two, three),
            (std::vector<double>{0, 0.5, 1, 1, 1.5, 2, 2, 2.5, 3}));
}

TEST(InitialState, IsMadeOnItsOwnGridAndInterpolated) {
  solver::Scene scene;
  scene.grid = {.rows = 31, .columns = 61, .dx = 0.6};
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.initial.noise = 1e-3;
  solver::OutputSink nowhere;
  const auto start = resolve_initial_state(scene, nowhere);
  const GridSettings own = scene.grid;
  move_to_spacing(scene, 0.3);
  EXPECT_EQ(scene.grid.rows, 61);
  const auto finer = resolve_initial_state(scene, nowhere);
  EXPECT_EQ(finer.rows, 61);
  EXPECT_EQ(finer.columns, 121);
  EXPECT_EQ(finer.V, resample(start.V, own, scene.grid));
  EXPECT_EQ(finer.r, resample(start.r, own, scene.grid));
}

}  // namespace
}  // namespace myowave::apps
