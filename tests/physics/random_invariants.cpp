// Properties of random scenes that follow from the form of the equations: symmetries and conserved sums.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/random_run.hpp"

namespace myowave::test {
namespace {

using solver::InitialState;
using solver::Scene;

// The scene and its state, transformed by one of the symmetries of the rectangle.
struct Turned {
  bool transposed, left_right, up_down;

  std::array<int, 2> size(const solver::GridSettings& grid) const {
    return transposed ? std::array{grid.columns, grid.rows} : std::array{grid.rows, grid.columns};
  }

  std::vector<double> operator()(const std::vector<double>& field, const solver::GridSettings& grid) const {
    std::vector<double> turned(field.size());
    const int columns = size(grid)[1];
    for (int i = 0; i < grid.rows; ++i)
      for (int j = 0; j < grid.columns; ++j) {
        const int row = up_down ? grid.rows - 1 - i : i, column = left_right ? grid.columns - 1 - j : j;
        turned[transposed ? column * columns + row : row * columns + column] = field[i * grid.columns + j];
      }
    return turned;
  }

  InitialState operator()(const InitialState& state, const solver::GridSettings& grid) const {
    const auto [rows, columns] = size(grid);
    return {rows, columns, (*this)(state.V, grid), (*this)(state.r, grid), (*this)(state.Ta, grid)};
  }

  Scene operator()(Scene scene) const {
    const solver::GridSettings grid = scene.grid;
    for (auto& stimulus : scene.stimuli) {
      const auto mirror = [](bool mirrored, int nodes, double& center, std::array<int, 2>& side) {
        if (!mirrored) return;
        center = nodes - 1 - center;
        side = {nodes - 1 - side[1], nodes - 1 - side[0]};
      };
      mirror(left_right, grid.columns, stimulus.center[0], stimulus.columns);
      mirror(up_down, grid.rows, stimulus.center[1], stimulus.rows);
      if (!transposed) continue;
      std::swap(stimulus.center[0], stimulus.center[1]);
      std::swap(stimulus.columns, stimulus.rows);
    }
    std::tie(scene.grid.rows, scene.grid.columns) = std::tuple_cat(size(grid));
    for (auto& probe : scene.output.probes) probe = {0, 0};
    return scene;
  }
};

// Nodes' shares of the sheet: a quarter of the area of each FD cell at a node, from the nodes of the
// elements.
std::vector<double> masses(const Scene& scene, const std::vector<double>& nodes) {
  const auto& grid = scene.grid;
  const int cells = nodes.empty() ? 1 : scene.mechanics->cells_per_element;
  const int element_columns = (grid.columns - 1) / cells;
  // Position of a grid node within element (I, J), by bilinear interpolation.
  const auto position = [&](int I, int J, int i, int j, int axis) {
    const double x = double(j) / cells - J, y = double(i) / cells - I;
    const auto at = [&](int row, int column) {
      return nodes[2 * (row * (element_columns + 1) + column) + axis];
    };
    return (1 - y) * ((1 - x) * at(I, J) + x * at(I, J + 1)) +
           y * ((1 - x) * at(I + 1, J) + x * at(I + 1, J + 1));
  };
  std::vector<double> mass(std::size_t(grid.rows) * grid.columns);
  for (int i = 0; i + 1 < grid.rows; ++i)
    for (int j = 0; j + 1 < grid.columns; ++j) {
      double area = 1;  // over dx^2: half the cross product of the diagonals
      if (!nodes.empty() && scene.metric != solver::MetricForm::none) {
        const auto diagonal = [&](int row, int column, int to_row, int to_column, int axis) {
          const int I = i / cells, J = j / cells;
          return (position(I, J, to_row, to_column, axis) - position(I, J, row, column, axis)) / grid.dx;
        };
        area = 0.5 * (diagonal(i, j, i + 1, j + 1, 0) * diagonal(i, j + 1, i + 1, j, 1) -
                      diagonal(i, j, i + 1, j + 1, 1) * diagonal(i, j + 1, i + 1, j, 0));
      }
      for (const int node : {0, 1, grid.columns, grid.columns + 1})
        mass[i * grid.columns + j + node] += area / 4;
    }
  return mass;
}

// Of the nodes at which a stimulus acts.
double stimulated(const solver::Stimulus& stimulus, const solver::GridSettings& grid,
                  const std::vector<double>& mass) {
  using Shape = solver::Stimulus::Shape;
  double sum = 0;
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j) {
      const bool in_block = i >= stimulus.rows[0] && i <= stimulus.rows[1] && j >= stimulus.columns[0] &&
                            j <= stimulus.columns[1];
      const double x = j - stimulus.center[0], y = i - stimulus.center[1];
      const bool in_disc = x * x + y * y <= stimulus.radius * stimulus.radius;
      if (stimulus.shape == Shape::all || (stimulus.shape == Shape::block ? in_block : in_disc))
        sum += mass[i * grid.columns + j];
    }
  return sum;
}

// Steps of the run that start during a pulse.
int stimulated_steps(const solver::Stimulus& stimulus, const Scene& scene) {
  int count = 0;
  for (std::int64_t step = 0; step < steps_of(scene.time.t_end, scene); ++step) {
    // In steps; a millionth of one covers decimal numbers that binary ones only come close to.
    const double since = static_cast<double>(step) - stimulus.start / scene.time.dt + 1e-6;
    const double period = stimulus.period / scene.time.dt, duration = stimulus.duration / scene.time.dt;
    if (since < 0 || stimulus.count == 0) continue;
    double pulse = period > 0 ? std::floor(since / period) : 0;
    if (stimulus.count > 0) pulse = std::min(pulse, static_cast<double>(stimulus.count - 1));
    if (since - pulse * period < duration) ++count;
  }
  return count;
}

double dot(const std::vector<double>& mass, const std::vector<double>& V, int power) {
  double sum = 0;
  for (std::size_t n = 0; n < V.size(); ++n) sum += mass[n] * std::pow(V[n], power);
  return sum;
}

// A round hill of tension somewhere on the sheet, so that a scene deforms from its first step on.
std::vector<double> hill_of_tension(const solver::GridSettings& grid, Draw& draw) {
  const double height = draw.number(5, 45), width = draw.number(0.1, 0.5) * std::max(grid.rows, grid.columns);
  const double row = draw.number(0, grid.rows), column = draw.number(0, grid.columns);
  std::vector<double> Ta;
  for (int i = 0; i < grid.rows; ++i)
    for (int j = 0; j < grid.columns; ++j)
      Ta.push_back(height * std::exp(-(std::pow(i - row, 2) + std::pow(j - column, 2)) / (width * width)));
  return Ta;
}

// The stencil adds opposite neighbours first, so a rigid sheet is exactly symmetric. Tension that does not
// load the sheet does not change V and r.
TEST(RandomInvariants, TurnedOrWithoutTensionAreBitwiseIdentical) {
  std::uint64_t seed = 0;
  for_random_scenes(100, random_scene, [&](const std::string& text) {
    Scene scene = parsed(text);
    scene.mechanics.reset();
    for (auto& one : scene.initial.preconditions) one.contraction = false;
    const InitialState initial = initial_state(scene);
    const Result straight = run(scene, initial);
    Draw draw(++seed);
    const Turned turned{draw.chance(0.5), draw.chance(0.5), draw.chance(0.5)};
    const Result other = run(turned(scene), turned(initial, scene.grid));
    ASSERT_EQ(straight.end, other.end);
    if (straight.end != End::done) return;
    EXPECT_TRUE(turned(straight.state.V, scene.grid) == other.state.V);
    EXPECT_TRUE(turned(straight.state.r, scene.grid) == other.state.r);
    EXPECT_TRUE(turned(straight.state.Ta, scene.grid) == other.state.Ta);

    scene.tension.law = solver::has_tension(scene) ? solver::TensionLaw::none : solver::TensionLaw::delayed;
    const Result without = run(scene, initial);
    EXPECT_TRUE(straight.state.V == without.state.V && straight.state.r == without.state.r);
  });
}

// k = 0 and r = 0 leave V_t = diffusion + I_s. While the metric is constant, the sum of M_i V_i changes only
// by the stimuli, and without stimuli the sum of M_i V_i^2 falls.
TEST(RandomInvariants, DiffusionAloneKeepsItsSumAndLosesItsSquares) {
  std::uint64_t seed = 0;
  int deformed = 0;
  for_random_scenes(200, random_scene, [&](const std::string& text) {
    Scene scene = parsed(text);
    Draw draw(++seed);
    scene.excitation.k = 0;
    scene.initial.r0 = 0;
    scene.initial.preconditions.clear();
    if (scene.metric == solver::MetricForm::expanded) scene.metric = solver::MetricForm::conservative;
    scene.time.stop_on = {};
    if (scene.mechanics) scene.mechanics->interval = 1000;  // more steps than there are
    if (draw.chance(0.5)) scene.stimuli.clear();
    InitialState initial = initial_state(scene);
    if (solver::has_tension(scene)) initial.Ta = hill_of_tension(scene.grid, draw);
    const Result result = run(scene, initial);
    expect_orderly_end(result);
    if (result.end != End::done) return;
    if (result.watch.smallest_J < 0.9) ++deformed;

    const std::vector<double> mass = masses(scene, result.watch.nodes);
    double brought = 0, brought_size = 0;
    for (const auto& stimulus : scene.stimuli) {
      const double each =
          scene.time.dt / scene.excitation.C_m * stimulus.amplitude * stimulated(stimulus, scene.grid, mass);
      brought += each * stimulated_steps(stimulus, scene);
      brought_size += std::abs(each) * stimulated_steps(stimulus, scene);
    }
    // The diffusion of a step is at most twice V (the stability bound), its terms at most four times; each
    // of the fewer than 16 roundings of a step is relative to that.
    const double steps = static_cast<double>(result.summary.steps);
    const double unit = scene.precision == solver::Precision::float32 ? 0x1p-24 : 0x1p-53;
    const double whole = dot(mass, std::vector<double>(mass.size(), 1), 1);
    const double largest_V = range_of(initial.V).size() + brought_size;
    EXPECT_NEAR(dot(mass, result.state.V, 1), dot(mass, initial.V, 1) + brought,
                16 * 5 * unit * (steps + 1) * whole * largest_V);
    if (scene.stimuli.empty()) {
      EXPECT_LE(dot(mass, result.state.V, 2),
                dot(mass, initial.V, 2) * (1 + 2 * 16 * 5 * unit * (steps + 1)));
    }
  });
  fmt::print("the sheet was deformed (J < 0.9) in {}\n", deformed);
}

}  // namespace
}  // namespace myowave::test
