#include "apps/input/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "solver/base/lagrange.hpp"

namespace myowave::apps {
namespace {

using solver::GridSettings;

// Of a spacing: what decimal numbers leave of a whole number of it.
constexpr double rounding = 1e-6;

// Four nodes around a place along a side, and Lagrange's weights of them.
struct Cubic {
  std::array<int, 4> nodes{};
  std::array<double, 4> weights{};

  // place: in node spacings from the first of `count` nodes.
  Cubic(double place, int count) {
    const int last = count - 1;
    const double nearest = std::round(place);
    if (std::abs(place - nearest) < rounding || count < 4) {
      // A node itself, or a line through the two beside the place.
      const int low = std::clamp(static_cast<int>(std::floor(place + rounding)), 0, last);
      const int high = std::min(low + 1, last);
      const double part = std::abs(place - nearest) < rounding ? 0 : place - low;
      nodes = {low, high, low, low};
      weights = {1 - part, part, 0, 0};
      return;
    }
    // At an edge the four nodes nearest to it.
    const int first = std::clamp(static_cast<int>(std::floor(place)) - 1, 0, count - 4);
    constexpr std::array places{0.0, 1.0, 2.0, 3.0};
    std::iota(nodes.begin(), nodes.end(), first);
    std::ranges::copy(solver::lagrange_weights(places, place - first), weights.begin());
  }
};

std::vector<Cubic> cubics(int from, int to, double ratio) {
  std::vector<Cubic> all;
  all.reserve(static_cast<std::size_t>(to));
  for (int n = 0; n < to; ++n) all.emplace_back(std::min(n * ratio, from - 1.0), from);
  return all;
}

int nearest_node(double place, int count) {
  return std::clamp(static_cast<int>(std::lround(place)), 0, count - 1);
}

void move_stimulus(solver::Stimulus& one, double ratio, const GridSettings& grid) {
  for (int* node : {&one.columns[0], &one.columns[1]}) *node = nearest_node(*node * ratio, grid.columns);
  for (int* node : {&one.rows[0], &one.rows[1]}) *node = nearest_node(*node * ratio, grid.rows);
  const auto [x, y] = one.center = {one.center[0] * ratio, one.center[1] * ratio};
  // At least the node that is nearest.
  one.radius = std::max(one.radius * ratio, std::hypot(x - std::round(x), y - std::round(y)));
}

}  // namespace

double spacing_of_run(const solver::Scene& scene) {
  const auto& [rows, columns, dx] = scene.grid;
  if (scene.dx == 0) return dx;
  const int cells = scene.mechanics ? scene.mechanics->cells_per_element : std::gcd(rows - 1, columns - 1);
  const double side = cells * dx;
  const double parts = std::max(1.0, std::ceil(side / scene.dx - rounding));
  return parts == cells ? dx : side / parts;
}

void move_to_spacing(solver::Scene& scene, double dx) {
  if (dx == scene.grid.dx) return;
  const double ratio = scene.grid.dx / dx;
  if (scene.initial.dx == 0) scene.initial.dx = scene.grid.dx;
  scene.grid = with_spacing(scene.grid, dx);
  for (auto& [row, column] : scene.output.probes) {
    row = nearest_node(row * ratio, scene.grid.rows);
    column = nearest_node(column * ratio, scene.grid.columns);
  }
  for (solver::Stimulus& one : scene.stimuli) move_stimulus(one, ratio, scene.grid);
  if (scene.mechanics)
    scene.mechanics->cells_per_element =
        static_cast<int>(std::lround(scene.mechanics->cells_per_element * ratio));
}

std::vector<double> resample(std::span<const double> field, const GridSettings& from,
                             const GridSettings& to) {
  const auto along_rows = cubics(from.rows, to.rows, to.dx / from.dx);
  const auto along_columns = cubics(from.columns, to.columns, to.dx / from.dx);
  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(to.rows) * static_cast<std::size_t>(to.columns));
  for (const Cubic& row : along_rows)
    for (const Cubic& column : along_columns) {
      double sum = 0, low = field[std::size_t(row.nodes[0]) * from.columns + column.nodes[0]], high = low;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          if (row.weights[i] == 0 || column.weights[j] == 0) continue;
          const double value = field[std::size_t(row.nodes[i]) * from.columns + column.nodes[j]];
          sum += row.weights[i] * column.weights[j] * value;
          low = std::min(low, value), high = std::max(high, value);
        }
      result.push_back(std::clamp(sum, low, high));
    }
  return result;
}

}  // namespace myowave::apps
