#include "tests/support/reference_coupled.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace myowave::reference {
namespace {

using solver::MetricForm;
using solver::Scene;
using solver::Stimulus;

Grid grid_of(const Scene& scene) { return {scene.grid.rows, scene.grid.columns, scene.grid.dx}; }

Mesh mesh_of(const Scene& scene) {
  const int cells = scene.mechanics->cells_per_element;
  if ((scene.grid.rows - 1) % cells != 0 || (scene.grid.columns - 1) % cells != 0)
    throw std::runtime_error("reference: the elements do not cover the grid");
  return {(scene.grid.rows - 1) / cells, (scene.grid.columns - 1) / cells, cells * scene.grid.dx};
}

bool is_on(const Stimulus& s, double t) {
  // A step belongs to its pulse whatever way t = step dt was rounded: 1.2 - 1 is less than 0.2.
  const double since = t - s.start + 1e-9;
  if (since < 0) return false;
  if (s.period <= 0) return s.count != 0 && since < s.duration;
  const auto pulse = static_cast<std::int64_t>(std::floor(since / s.period));
  return (s.count < 0 || pulse < s.count) && since - static_cast<double>(pulse) * s.period < s.duration;
}

bool is_inside(const Stimulus& s, int i, int j) {
  switch (s.shape) {
    case Stimulus::Shape::all:
      return true;
    case Stimulus::Shape::disc:
      return std::hypot(j - s.center[0], i - s.center[1]) <= s.radius;
    case Stimulus::Shape::block:
      return s.columns[0] <= j && j <= s.columns[1] && s.rows[0] <= i && i <= s.rows[1];
  }
  return false;
}

struct Solve {
  double t;
  Values nodes;
};

double largest_difference(const Values& a, const Values& b) {
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, std::abs(a[n] - b[n]));
  return largest;
}

// The polynomial through the last `count` solves at t, by Lagrange's formula.
Values extrapolated(const std::vector<Solve>& solves, std::size_t count, double t) {
  Values nodes(solves.back().nodes.size());
  for (std::size_t n = solves.size() - count; n < solves.size(); ++n) {
    double weight = 1;
    for (std::size_t m = solves.size() - count; m < solves.size(); ++m)
      if (m != n) weight *= (t - solves[m].t) / (solves[n].t - solves[m].t);
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] += weight * solves[n].nodes[k];
  }
  return nodes;
}

// At most one and a half spacings of the last two solves past the last; of fewer solves where a corner is
// turned.
Values metric_nodes(const Scene& scene, const std::vector<Solve>& solves, double t) {
  if (solves.size() > 1) {
    const double last = solves.back().t, before = solves[solves.size() - 2].t;
    t = std::min(t, last + 1.5 * (last - before));
  }
  for (std::size_t count = std::min(solves.size(), 1 + static_cast<std::size_t>(scene.metric_time));
       count > 1; --count) {
    const Values nodes = extrapolated(solves, count, t);
    if (smallest_corner_J(mesh_of(scene), nodes) > 0) return nodes;
  }
  return solves.back().nodes;
}

}  // namespace

Values stimulus(const Scene& scene, double t) {
  const Grid grid = grid_of(scene);
  Values I_s(grid.size());
  for (const Stimulus& s : scene.stimuli)
    for (int i = 0; i < grid.rows; ++i)
      for (int j = 0; j < grid.columns; ++j)
        if (is_on(s, t) && is_inside(s, i, j)) I_s[grid.node(i, j)] += s.amplitude;
  return I_s;
}

Values diffusion(const Scene& scene, const Values& nodes, const Values& V) {
  const Grid grid = grid_of(scene);
  if (!scene.mechanics || scene.metric == MetricForm::none) return diffusion_identity(grid, V);
  return scene.metric == MetricForm::conservative ? diffusion_conservative(grid, mesh_of(scene), nodes, V)
                                                  : diffusion_expanded(grid, mesh_of(scene), nodes, V);
}

CoupledState run(const Scene& scene, const ExcitationState& initial, int steps) {
  CoupledState state{initial, {}};
  const double dt = scene.time.dt;
  Values equilibrium, solved_Ta, felt;
  std::vector<Solve> taken;
  const auto solve = [&](const Values& Ta) {
    equilibrium = solve_equilibrium(mesh_of(scene), *scene.mechanics, Ta, equilibrium);
    solved_Ta = Ta;
  };
  const auto equilibrium_at = [&](double t) -> Solve {
    const Values no_tension(initial.Ta.size());
    const Values Ta = tension_to_gauss(mesh_of(scene), grid_of(scene),
                                       scene.mechanics->contraction ? state.fields.Ta : no_tension);
    if (largest_difference(Ta, solved_Ta) > 0) {
      solve(Ta);
      ++state.solves;
    }
    return {t, equilibrium};
  };
  if (scene.mechanics) {
    equilibrium = undeformed(mesh_of(scene));
    solve(Values(4 * static_cast<std::size_t>(mesh_of(scene).elements())));
  }
  for (int step = 0;; ++step) {
    const double t = step * dt;
    if (scene.mechanics && step % scene.mechanics->interval == 0) {
      taken.push_back(equilibrium_at(t));
      state.nodes = taken.back().nodes;
      felt = metric_nodes(scene, taken, t + 0.5 * scene.mechanics->interval * dt);
    }
    if (step == steps) return state;
    state.fields = euler_step(scene.excitation, scene.tension, dt, state.fields,
                              diffusion(scene, felt, state.fields.V), stimulus(scene, t));
  }
}

}  // namespace myowave::reference
