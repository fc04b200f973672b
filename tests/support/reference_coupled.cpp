#include "tests/support/reference_coupled.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

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
  const auto solve = [&](const Values& Ta) {
    const Mesh mesh = mesh_of(scene);
    state.nodes =
        solve_equilibrium(mesh, *scene.mechanics, tension_to_gauss(mesh, grid_of(scene), Ta), state.nodes);
  };
  const Values no_tension(initial.Ta.size());
  if (scene.mechanics) {
    state.nodes = undeformed(mesh_of(scene));
    solve(no_tension);
  }
  for (int step = 0;; ++step) {
    if (scene.mechanics && step % scene.mechanics->interval == 0)
      solve(scene.mechanics->contraction ? state.fields.Ta : no_tension);
    if (step == steps) return state;
    state.fields =
        euler_step(scene.excitation, scene.tension, scene.time.dt, state.fields,
                   diffusion(scene, state.nodes, state.fields.V), stimulus(scene, step * scene.time.dt));
  }
}

}  // namespace myowave::reference
