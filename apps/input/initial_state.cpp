#include "apps/input/initial_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <random>

#include "apps/base/signals.hpp"
#include "apps/input/resample.hpp"
#include "apps/input/state_cache.hpp"
#include "solver/base/error.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave::apps {
namespace {

using solver::InitialState;
using solver::InputError;

// The protocol of the settled spiral: a broken front on a sheet where the spiral stays whole at
// b = 0.11, followed until it rotates about one place.
constexpr int protocol_nodes = 251;
constexpr double protocol_b = 0.11;
constexpr double protocol_duration = 1080;  // t.u.
// Node of the core at its end.
constexpr int core_row = 81;
constexpr int core_column = 131;

// Passes on the progress of a run that only prepares another one.
class SettlingProgress final : public solver::OutputSink {
 public:
  explicit SettlingProgress(solver::OutputSink& progress) : progress_(progress) {}
  void progress(const solver::Progress& p) override {
    solver::Progress told = p;
    told.stage.kind = solver::RunStage::Kind::settling;
    progress_.progress(told);
  }

 private:
  solver::OutputSink& progress_;
};

solver::Scene settling_scene(int rows, int columns) {
  solver::Scene scene;
  scene.name = "settled_spiral";
  scene.grid.rows = rows;
  scene.grid.columns = columns;
  scene.excitation.b = protocol_b;
  scene.time.t_end = protocol_duration;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.every = scene.output.tips_every = scene.output.probes_every = protocol_duration;
  return scene;
}

// Every number that the result depends on.
std::string definition(const solver::Scene& scene) {
  const solver::ExcitationSettings& cell = scene.excitation;
  const auto [k_Ta, eps_below, eps_above, threshold] = solver::tension_parameters(scene.tension);
  const auto& [rows, columns, dx] = scene.grid;
  return fmt::format(
      "settled spiral: {} x {} nodes, dx {}, dt {}, t {}; a {}, b {}, k {}, eps {}, mu1 {}, mu2 {}, C_m {}, "
      "D {}; "
      "k_Ta {}, eps_T {} {} at {}; broken front {} {} [{}, {}]",
      rows, columns, dx, scene.time.dt, scene.time.t_end, cell.a, cell.b, cell.k, cell.eps, cell.mu1,
      cell.mu2, cell.C_m, cell.D, k_Ta, eps_below, eps_above, threshold, scene.initial.width,
      scene.initial.r0, scene.initial.offset[0], scene.initial.offset[1]);
}

InitialState cut(const InitialState& whole, int row0, int column0, int rows, int columns) {
  InitialState part{rows, columns, {}, {}, {}};
  for (auto field : {&InitialState::V, &InitialState::r, &InitialState::Ta}) {
    for (int i = 0; i < rows; ++i) {
      const auto begin = (whole.*field).begin() + std::ptrdiff_t(row0 + i) * whole.columns + column0;
      (part.*field).insert((part.*field).end(), begin, begin + columns);
    }
  }
  return part;
}

// First row and column of the scene's window in the protocol's sheet; empty where it leaves that.
std::optional<std::array<int, 2>> window_of_protocol(const solver::Scene& scene) {
  const auto& [rows, columns, dx] = scene.grid;
  const auto [column_offset, row_offset] = scene.initial.core_offset;
  const int row0 = core_row - (rows - 1) / 2 - row_offset;
  const int column0 = core_column - (columns - 1) / 2 - column_offset;
  const auto inside = [](int first, int count) { return first >= 0 && first + count <= protocol_nodes; };
  return inside(row0, rows) && inside(column0, columns) ? std::optional(std::array{row0, column0})
                                                        : std::nullopt;
}

// On the protocol's sheet where the scene's is a part of it, else on one of the scene's size; the core is
// then where it settles.
solver::Scene scene_to_settle(const solver::Scene& scene) {
  return window_of_protocol(scene) ? settling_scene(protocol_nodes, protocol_nodes)
                                   : settling_scene(scene.grid.rows, scene.grid.columns);
}

solver::Scene on_grid_of_start(solver::Scene scene) {
  scene.grid = grid_of_start(scene);
  return scene;
}

InitialState settle(const solver::Scene& scene, solver::OutputSink& progress) {
  const std::string text = definition(scene);
  return cached_state(cached_state_path("settled_spiral", text), text, [&] {
    SettlingProgress told(progress);
    solver::RunSummary summary;
    return solver::run(scene, solver::make_initial_state(scene), told, summary, {.stop = &stop_requested()});
  });
}

InitialState settled_spiral(const solver::Scene& scene, solver::OutputSink& progress) {
  require_settled_spiral(scene);
  const auto& [rows, columns, dx] = scene.grid;
  InitialState settled = settle(scene_to_settle(scene), progress);
  const auto window = window_of_protocol(scene);
  return window ? cut(settled, (*window)[0], (*window)[1], rows, columns) : settled;
}

InitialState from_type(const solver::Scene& scene, solver::OutputSink& progress) {
  using Type = solver::InitialSettings::Type;
  switch (scene.initial.type) {
    case Type::rest:
    case Type::broken_front:
      return solver::make_initial_state(scene);
    case Type::settled_spiral:
      return settled_spiral(scene, progress);
    case Type::file:
      return read_state(scene.initial.file, scene.grid.rows, scene.grid.columns, scene.initial.window);
  }
  std::abort();
}

// Normal deviates by Box and Muller from uniform ones in (0, 1]: the standard fixes the engine's
// numbers but leaves std::normal_distribution to each library.
void add_noise(std::vector<double>& V, double sd, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&engine] { return (double(engine() >> 11) + 1) * 0x1p-53; };
  for (std::size_t n = 0; n < V.size(); n += 2) {
    const double radius = sd * std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    V[n] += radius * std::cos(angle);
    if (n + 1 < V.size()) V[n + 1] += radius * std::sin(angle);
  }
}

}  // namespace

void require_settled_spiral(const solver::Scene& scene) {
  const auto [rows, columns, dx] = grid_of_start(scene);
  if (dx != solver::GridSettings{}.dx) {
    throw InputError(fmt::format(
        "initial.type = \"settled_spiral\" is defined at grid.dx = {0}, not {1}: set initial.dx = {0} "
        "for one that is interpolated, or start from \"broken_front\" or a \"file\"",
        solver::GridSettings{}.dx, dx));
  }
  const auto [column_offset, row_offset] = scene.initial.core_offset;
  if ((column_offset != 0 || row_offset != 0) && !window_of_protocol(on_grid_of_start(scene))) {
    throw InputError(fmt::format(
        "initial.core_offset = [{}, {}]: a window of {} x {} nodes with the core there leaves "
        "the settled sheet of {} x {} (core at row {}, column {})",
        column_offset, row_offset, rows, columns, protocol_nodes, protocol_nodes, core_row, core_column));
  }
}

std::optional<solver::Scene> spiral_to_settle(const solver::Scene& scene) {
  if (scene.initial.type != solver::InitialSettings::Type::settled_spiral) return std::nullopt;
  solver::Scene settling = scene_to_settle(on_grid_of_start(scene));
  const bool there = std::filesystem::exists(cached_state_path("settled_spiral", definition(settling)));
  return there ? std::nullopt : std::optional(std::move(settling));
}

InitialState resolve_initial_state(const solver::Scene& scene, solver::OutputSink& progress) {
  const solver::Scene on_start = on_grid_of_start(scene);
  InitialState state = from_type(on_start, progress);
  if (scene.initial.noise > 0) add_noise(state.V, scene.initial.noise, scene.initial.seed);
  if (on_start.grid.dx == scene.grid.dx) return state;
  for (auto field : {&InitialState::V, &InitialState::r, &InitialState::Ta})
    state.*field = resample(state.*field, on_start.grid, scene.grid);
  state.rows = scene.grid.rows, state.columns = scene.grid.columns;
  return state;
}

}  // namespace myowave::apps
