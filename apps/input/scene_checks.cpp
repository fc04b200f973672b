#include "apps/input/scene_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "apps/input/presets.hpp"
#include "apps/input/resample.hpp"
#include "solver/mechanics/rest_state.hpp"

namespace myowave::apps {
namespace {

using solver::Scene;

class SceneChecks {
 public:
  explicit SceneChecks(ReadScene& read) : read_(read) {}

  void check() {
    const double spacing = check_spacing();
    check_representable(spacing);
    check_time();
    check_tension("tension", scene_.tension);
    check_mechanics();
    check_scheme();
    check_initial(read_);
    check_preconditions();
    check_stimuli();
    check_output();
    move_to_spacing(scene_, spacing);
  }

 private:
  bool fine(std::initializer_list<std::string_view> paths) const { return read_.fine(paths); }
  void conflict(std::initializer_list<std::string> paths, const std::string& message) {
    read_.conflict(paths, message);
  }

  // A step adds dt times what it divides by dx^2: 0 or infinity there would be a run of nothing.
  void check_representable(double spacing) {
    const bool single = scene_.precision == solver::Precision::float32;
    const double smallest = single ? std::numeric_limits<float>::min() : std::numeric_limits<double>::min();
    const double largest = single ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
    const auto check = [&](std::string_view path, double given, std::string_view what, double value) {
      if (!fine({path, "accuracy.precision"}) || (value >= smallest && value <= largest)) return;
      conflict({std::string(path), "accuracy.precision"},
               fmt::format("{} = {}: {} = {:.2g} is outside of {} ({:.2g} to {:.2g})", path, given, what,
                           value, single ? "float32" : "float64", smallest, largest));
    };
    check("time.dt", scene_.time.dt, "dt", scene_.time.dt);
    check("grid.dx", scene_.grid.dx, "1/dx^2", 1 / (scene_.grid.dx * scene_.grid.dx));
    if (spacing != scene_.grid.dx) check("accuracy.dx", scene_.dx, "1/dx^2", 1 / (spacing * spacing));
  }

  // The run's spacing; a preset's dt, which is for its own, follows it.
  double check_spacing() {
    if (!sheet_known_ || !fine({"grid.dx", "accuracy.dx", "mechanics.cells_per_element"}))
      return scene_.grid.dx;
    const double spacing = spacing_of_run(scene_);
    if (!check_node_count(read_, "accuracy.dx", scene_.dx, spacing)) return scene_.grid.dx;
    const auto dt = given_.find("time.dt");
    if (dt != given_.end() && read_.tables.origins.is_from_preset(*dt->second))
      scene_.time.dt = dt_of_preset(spacing);
    return spacing;
  }

  // A preset's dt is for its own spacing and D = C_m; up to a fifth more of D dt / dx^2 is as stable and
  // nearly as accurate, and so is up to a fifth more to be a whole part of the shortest interval of outputs.
  double dt_of_preset(double spacing) const {
    constexpr double a_fifth_more = 1.2, rounding = 1e-9;
    const Preset& preset = *find_preset(scene_.preset);
    const PresetValue& dx = *find_value(preset, "accuracy.dx", scene_.mechanics.has_value());
    const double finer = std::strtod(std::string(dx.value).c_str(), nullptr) / spacing;
    const double parts = finer * finer * scene_.excitation.D / scene_.excitation.C_m / a_fifth_more;
    const double longest = scene_.time.dt / std::max(1.0, std::ceil(parts));
    const solver::OutputSettings& output = scene_.output;
    const double interval = std::min({output.every, output.tips_every, output.probes_every});
    const double steps = interval / longest, fewer = std::floor(steps);
    return interval / (a_fifth_more * fewer > steps - rounding ? fewer : std::ceil(steps));
  }

  void check_time() {
    if (fine({"time.dt", "time.t_end"})) check_step_count("time.t_end", scene_.time.t_end);
  }

  void check_step_count(const std::string& path, double duration) {
    constexpr double most_steps = 1e15;
    const double steps = duration / scene_.time.dt;
    if (!(steps <= most_steps)) {
      conflict({path, "time.dt"},
               fmt::format("{} = {} with time.dt = {} is {:.2g} steps; at most {:g} can be counted", path,
                           duration, scene_.time.dt, steps, most_steps));
    }
  }

  // An explicit step past 1/rate overshoots the tension it relaxes to.
  void check_tension(const std::string& section, const solver::TensionSettings& settings) {
    if (!fine({"time.dt", section + ".eps0", section + ".eps_below", section + ".eps_above"})) return;
    const auto tension = solver::tension_parameters(settings);
    for (const auto& [name, rate] :
         {std::pair("eps_below", tension.eps_below), std::pair("eps_above", tension.eps_above)}) {
      if (rate * scene_.time.dt <= 1) continue;
      conflict({section + "." + name, section + ".eps0", "tension." + std::string(name), "tension.eps0",
                "time.dt"},
               fmt::format("{}.{} = {} is too fast for time.dt = {}: the rate times the step must be <= 1",
                           section, name, rate, scene_.time.dt));
    }
  }

  void check_mechanics() {
    if (!scene_.mechanics) return;
    const solver::MechanicsSettings& mechanics = *scene_.mechanics;
    if (sheet_known_ && fine({"mechanics.cells_per_element"})) {
      check_divides("columns", scene_.grid.columns, mechanics.cells_per_element);
      if (scene_.grid.rows != scene_.grid.columns)
        check_divides("rows", scene_.grid.rows, mechanics.cells_per_element);
    }
    if (fine({"tension.law", "mechanics.contraction"}) && scene_.tension.law == solver::TensionLaw::none &&
        mechanics.contraction)
      conflict(
          {"tension.law", "mechanics.contraction", "mechanics"},
          "tension.law = \"none\" leaves mechanics.contraction = true without a tension; set it to false, or "
          "the law to \"delayed\" or \"printed\"");
    if (fine({"mechanics.c1", "mechanics.c2"}) && mechanics.c1 == 0 && mechanics.c2 == 0) {
      conflict({"mechanics.c1", "mechanics.c2"},
               "mechanics.c1 and mechanics.c2 are both 0: a sheet without stiffness has no equilibrium");
    } else if (fine({"mechanics.c1", "mechanics.c2", "mechanics.p", "mechanics.load", "mechanics.edges"})) {
      const auto reason = solver::why_no_rest_state(mechanics);
      if (reason)
        conflict({"mechanics.p", "mechanics.load", "mechanics.c2", "mechanics.c1", "mechanics"}, *reason);
    }
  }

  void check_scheme() {
    if (scene_.scheme == solver::Scheme::split && scene_.mechanics &&
        scene_.metric == solver::MetricForm::expanded && fine({"accuracy.scheme", "feedback.metric"}))
      conflict(
          {"accuracy.scheme", "feedback.metric"},
          "accuracy.scheme = \"split\" has no feedback.metric = \"expanded\"; set the first to \"euler\" "
          "or the second to \"conservative\"");
  }

  void check_divides(std::string_view side, std::int64_t nodes, std::int64_t cells) {
    if ((nodes - 1) % cells == 0) return;
    const std::int64_t below = (nodes - 1) / cells * cells + 1;
    const std::string nearest =
        below > 1 ? fmt::format("the nearest sizes that are: {} and {}", below, below + cells)
                  : fmt::format("the smallest size that is: {}", below + cells);
    const std::string name =
        scene_.grid.rows == scene_.grid.columns ? "grid.n" : fmt::format("grid.n: {}", side);
    conflict(
        {"grid.n", "mechanics.cells_per_element", "mechanics"},
        fmt::format("{} = {}: {} - 1 = {} cells are not divisible by mechanics.cells_per_element = {}; {}",
                    name, nodes, nodes, nodes - 1, cells, nearest));
  }

  void check_preconditions() {
    for (std::size_t i = 0; i < scene_.initial.preconditions.size(); ++i) {
      const solver::Precondition& one = scene_.initial.preconditions[i];
      const std::string& path = read_.precondition_paths[i];
      if (one.contraction && !scene_.mechanics && fine({"mechanics.on"})) {
        conflict({path + ".contraction"},
                 fmt::format("{}.contraction = true needs [mechanics]; this scene is rigid", path));
      }
      if (fine({"tension.law", path + ".law"}) && one.contraction &&
          one.tension.law == solver::TensionLaw::none)
        conflict({path + ".contraction", path + ".law", "tension.law"},
                 fmt::format("{}.contraction = true needs a tension.law other than \"none\"", path));
      if (fine({"time.dt", path + ".duration"})) check_step_count(path + ".duration", one.duration);
      const bool own_rates =
          std::ranges::any_of(std::array{".law", ".eps0", ".eps_below", ".eps_above"},
                              [&](const char* key) { return given_.contains(path + key); });
      if (own_rates) check_tension(path, one.tension);
    }
  }

  void check_stimuli() {
    for (std::size_t i = 0; i < scene_.stimuli.size(); ++i) {
      const solver::Stimulus& one = scene_.stimuli[i];
      const std::string& path = read_.stimulus_paths[i];
      if (fine({path + ".duration", path + ".period"}) && one.period > 0 && one.duration > one.period) {
        conflict({path + ".duration", path + ".period"},
                 fmt::format("{}.duration = {} is longer than its period = {}: pulses would overlap", path,
                             one.duration, one.period));
      }
      if (fine({path + ".count", path + ".period"}) && one.period == 0 && (one.count > 1 || one.count < 0)) {
        conflict({path + ".count"}, fmt::format("{}.count = {} needs a period > 0", path, one.count));
      }
      if (fine({path + ".duration", "time.dt"}) && one.duration < scene_.time.dt) {
        conflict({path + ".duration", "time.dt"},
                 fmt::format("{}.duration = {} is shorter than a step (time.dt = {})", path, one.duration,
                             scene_.time.dt));
      }
      if (sheet_known_ && fine({path + ".region"})) check_region(path + ".region", one);
    }
  }

  void check_region(const std::string& path, const solver::Stimulus& one) {
    using Shape = solver::Stimulus::Shape;
    const int columns = scene_.grid.columns, rows = scene_.grid.rows;
    if (one.shape == Shape::block) {
      const auto outside = [](const std::array<int, 2>& side, int nodes) {
        return side[0] < 0 || side[1] >= nodes;
      };
      if (one.columns[0] > one.columns[1] || one.rows[0] > one.rows[1]) {
        conflict({path},
                 fmt::format("{}: columns = [{}, {}], rows = [{}, {}]: the last node comes before the first",
                             path, one.columns[0], one.columns[1], one.rows[0], one.rows[1]));
      } else if (outside(one.columns, columns) || outside(one.rows, rows)) {
        conflict({path}, fmt::format("{}: columns = [{}, {}], rows = [{}, {}] leave the sheet ({})", path,
                                     one.columns[0], one.columns[1], one.rows[0], one.rows[1],
                                     sheet_text(scene_.grid)));
      }
    }
    if (one.shape == Shape::disc) {
      const auto& [x, y] = one.center;
      if (!(x >= 0 && x <= columns - 1 && y >= 0 && y <= rows - 1)) {
        conflict({path}, fmt::format("{}: center = [{}, {}] (column, row) is outside of the sheet ({})", path,
                                     x, y, sheet_text(scene_.grid)));
      } else if (std::hypot(x - std::round(x), y - std::round(y)) > one.radius) {
        conflict({path}, fmt::format("{}: no node lies within radius = {} of center = [{}, {}]", path,
                                     one.radius, x, y));
      }
    }
  }

  void check_output() {
    solver::OutputSettings& output = scene_.output;
    if (given_.contains("output.every")) {
      check_multiple("output.every", output.every);
    } else if (fine({"time.dt"})) {
      follow_step(output);
    }
    if (!given_.contains("output.tension")) output.tension = scene_.mechanics || output.fields;
    if (output.tips_every != output.every) check_multiple("output.tips_every", output.tips_every);
    if (output.probes_every != output.every) check_multiple("output.probes_every", output.probes_every);
    if (!sheet_known_) return;
    const int columns = scene_.grid.columns, rows = scene_.grid.rows;
    if (output.probes.empty()) {
      const int bottom = (rows - 1) / 4, left = (columns - 1) / 4;
      const int top = rows - 1 - bottom, right = columns - 1 - left;
      output.probes = {{bottom, left}, {bottom, right}, {top, left}, {top, right}};
    }
    for (const auto& [row, column] : output.probes) {
      if (row >= 0 && row < rows && column >= 0 && column < columns) continue;
      conflict({"output.probes"},
               fmt::format("output.probes: [{}, {}] (row, column) is outside of the sheet ({})", row, column,
                           sheet_text(scene_.grid)));
    }
  }

  // A default that no step meets would be nobody's mistake: the multiple of dt that is nearest to it.
  void follow_step(solver::OutputSettings& output) const {
    const double dt = scene_.time.dt;
    const double every = std::max(1.0, std::round(output.every / dt)) * dt;
    if (!given_.contains("output.tips_every")) output.tips_every = every;
    if (!given_.contains("output.probes_every")) output.probes_every = every;
    output.every = every;
  }

  void check_multiple(const std::string& path, double every) {
    if (!fine({path, "output.every", "time.dt"})) return;
    const double dt = scene_.time.dt;
    const double steps = every / dt;
    if (!(steps < 1e15)) {
      check_step_count(path, every);
      return;
    }
    // 1e-6 of a step covers decimal numbers that binary ones only come close to.
    if (std::round(steps) >= 1 && std::abs(steps - std::round(steps)) < 1e-6) return;
    const double below = std::floor(steps);
    const std::string nearest =
        below < 1 ? fmt::format("the smallest is {:g}", dt)
                  : fmt::format("the nearest are {:g} and {:g}", below * dt, (below + 1) * dt);
    conflict({path, "output.every", "time.dt"},
             fmt::format("{} = {} is not a multiple of time.dt = {}; {}", path, every, dt, nearest));
  }

  ReadScene& read_;
  Scene& scene_ = read_.scene;
  const std::map<std::string, const toml::node*>& given_ = read_.given;
  // grid.n is no error, so that others can be compared with it.
  const bool sheet_known_ = read_.fine({"grid.n"});
};

}  // namespace

std::string sheet_text(const solver::GridSettings& sheet) {
  return fmt::format("columns 0 to {}, rows 0 to {}", sheet.columns - 1, sheet.rows - 1);
}

bool check_node_count(ReadScene& read, const std::string& path, double given, double spacing) {
  constexpr double most_nodes = 1e7;  // as grid.n
  const double side = std::max(read.scene.grid.rows - 1, read.scene.grid.columns - 1) * read.scene.grid.dx;
  if (side / spacing < most_nodes) return true;
  read.conflict(
      {path},
      fmt::format("{} = {} puts {:.2g} nodes along a side of {:g} length units; at most {:g} are allowed: "
                  "set it to {:.2g} or more",
                  path, given, side / spacing, side, most_nodes, side / most_nodes));
  return false;
}

void check_scene(ReadScene& read) { SceneChecks(read).check(); }

}  // namespace myowave::apps
