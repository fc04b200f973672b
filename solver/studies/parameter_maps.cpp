#include "solver/studies/parameter_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>
#include <vector>

#include "kernels/elastic/kinematics.hpp"
#include "solver/base/error.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"

namespace myowave::solver {
namespace {

InitialState initial_state(const ParameterCase& c) {
  InitialState state = make_initial_state(c.scene);
  if (c.prepare) c.prepare(state);
  return state;
}

InitialState run_quietly(const Scene& scene, InitialState state, RunSummary& summary) {
  OutputSink nowhere;
  return run(scene, std::move(state), nowhere, summary);
}

// The same model at another step, in float64. The mechanics is solved at the same times.
Scene at_step(Scene scene, double dt) {
  if (scene.mechanics) {
    const double interval = scene.mechanics->interval * scene.time.dt / dt;
    scene.mechanics->interval = std::max(1, static_cast<int>(std::lround(interval)));
  }
  scene.time.dt = dt;
  scene.precision = Precision::float64;
  return scene;
}

double distance(const InitialState& state, const InitialState& reference) {
  double difference = 0, norm = 0;
  const auto add = [&](const std::vector<double>& values, const std::vector<double>& wanted) {
    for (std::size_t n = 0; n < values.size(); ++n) {
      difference += (values[n] - wanted[n]) * (values[n] - wanted[n]);
      norm += wanted[n] * wanted[n];
    }
  };
  add(state.V, reference.V);
  add(state.r, reference.r);
  return norm > 0 ? std::sqrt(difference / norm) : std::sqrt(difference);
}

double largest(const std::vector<double>& values) { return *std::ranges::max_element(values); }

}  // namespace

ParameterResult run_case(const ParameterCase& c) {
  ParameterResult result;
  InitialState end;
  RunSummary summary, of_reference;
  try {
    end = run_quietly(c.scene, initial_state(c), summary);
  } catch (const InputError& refusal) {
    return {.outcome = ParameterOutcome::refused, .reason = refusal.what()};
  } catch (const NumericalFailure& failure) {
    return {.outcome = ParameterOutcome::stopped, .reason = failure.what()};
  }
  result.largest_V = largest(end.V);
  const double dt = c.reference_dt > 0 ? c.reference_dt : c.scene.time.dt / 8;
  try {
    result.error = distance(end, run_quietly(at_step(c.scene, dt), initial_state(c), of_reference));
    if (result.error < largest_error) {
      result.outcome = ParameterOutcome::right;
    } else if (!summary.warnings.empty()) {
      result.outcome = ParameterOutcome::warned;
      result.reason = summary.warnings.front();
    }
  } catch (const NumericalFailure& failure) {
    result.reason = fmt::format("the reference: {}", failure.what());
  }
  return result;
}

namespace {

constexpr double front_time = 10;  // t.u., in which the front crosses the small sheet

Scene small_sheet(bool coupled) {
  Scene scene;
  scene.grid = {31, 31, 0.6};
  scene.time.t_end = front_time;
  scene.initial.type = InitialSettings::Type::broken_front;
  scene.output.tips_every = front_time;
  if (coupled) scene.mechanics.emplace();
  return scene;
}

class Cases {
 public:
  // On the rigid and on the contracting sheet.
  void add(const std::string& what, const std::vector<double>& values,
           const std::function<void(Scene&, double)>& set) {
    for (const bool coupled : {false, true})
      for (const double value : values) {
        ParameterCase one{.what = what, .value = fmt::format("{:g}", value), .scene = small_sheet(coupled)};
        set(one.scene, value);
        cases.push_back(std::move(one));
      }
  }
  ParameterCase& one(const std::string& what, const std::string& value, bool coupled) {
    cases.push_back({.what = what, .value = value, .scene = small_sheet(coupled)});
    return cases.back();
  }

  std::vector<ParameterCase> cases;
};

void add_excitation(Cases& cases) {
  cases.add("none", {0}, [](Scene&, double) {});
  cases.add("excitation.mu1", {0, 10}, [](Scene& s, double v) { s.excitation.mu1 = v; });
  cases.add("excitation.eps", {0, 1, 100}, [](Scene& s, double v) { s.excitation.eps = v; });
  cases.add("excitation.mu1 and eps", {0},
            [](Scene& s, double v) { s.excitation.mu1 = s.excitation.eps = v; });
  cases.add("excitation.mu2", {1e-1, 1e-2, 1e-3, 1e-6, 1e6},
            [](Scene& s, double v) { s.excitation.mu2 = v; });
  cases.add("excitation.k", {0, 20, 50, 70, 86, 111, 200}, [](Scene& s, double v) { s.excitation.k = v; });
  cases.add("excitation.a", {0, 0.5, 1}, [](Scene& s, double v) { s.excitation.a = v; });
  cases.add("excitation.b", {-1, 1, 10}, [](Scene& s, double v) { s.excitation.b = v; });
  cases.add("excitation.D", {0, 1e-3, 2.3, 2.6, 100}, [](Scene& s, double v) { s.excitation.D = v; });
  cases.add("excitation.C_m", {1e-3, 0.4, 100}, [](Scene& s, double v) { s.excitation.C_m = v; });
  for (const double r : {-0.02, -0.03, -0.1, -1.0, 10.0, 100.0}) {
    ParameterCase& one = cases.one("r at rest", fmt::format("{:g}", r), false);
    one.scene.grid = {11, 11, 0.6};
    one.scene.time.t_end = 400;
    one.scene.initial.type = InitialSettings::Type::rest;
    one.prepare = [r](InitialState& state) { std::ranges::fill(state.r, r); };
  }
}

void add_stimuli(Cases& cases) {
  cases.add("stimulus.amplitude", {-10, -0.3, 0.5, 5, 10, 20, 50, 100, 1e3, 1e6, 1e300},
            [](Scene& s, double amplitude) {
              s.initial.type = InitialSettings::Type::rest;
              s.stimuli.push_back({.start = 1,
                                   .amplitude = amplitude,
                                   .shape = Stimulus::Shape::disc,
                                   .center = {15, 15},
                                   .radius = 5});
            });
}

void add_steps_and_sheets(Cases& cases) {
  cases.add("time.dt", {0.05, 0.069, 0.07, 1}, [](Scene& s, double v) { s.time.dt = v; });
  for (const auto precision : {Precision::float64, Precision::float32})
    for (const double dt : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
      const char* name = precision == Precision::float64 ? "float64" : "float32";
      ParameterCase& one = cases.one(fmt::format("time.dt in {}", name), fmt::format("{:g}", dt), false);
      one.scene.precision = precision;
      one.scene.time.dt = dt;
      one.scene.time.t_end = 2e5 * dt;
      one.scene.grid = {11, 11, 0.6};
      one.reference_dt = std::min(100 * dt, 0.0025);
    }
  for (const bool coupled : {false, true}) {
    cases.one("accuracy.precision", "float32", coupled).scene.precision = Precision::float32;
    for (const auto& [rows, columns] : {std::pair{11, 11}, {11, 31}, {31, 11}, {21, 201}})
      cases.one("grid.n", fmt::format("[{}, {}]", rows, columns), coupled).scene.grid = {rows, columns, 0.6};
  }
  for (const auto& [rows, columns] : {std::pair{2, 2}, {2, 50}, {50, 2}, {3, 3}})
    cases.one("grid.n", fmt::format("[{}, {}]", rows, columns), false).scene.grid = {rows, columns, 0.6};
  cases.add("grid.dx", {0.05, 0.3, 10, 1e6}, [](Scene& s, double v) { s.grid.dx = v; });
}

void add_mechanics(Cases& cases) {
  for (const int interval : {1, 10, 160, 100000})
    cases.one("mechanics.interval", fmt::format("{}", interval), true).scene.mechanics->interval = interval;
  for (const int cells : {1, 2, 30})
    cases.one("mechanics.cells_per_element", fmt::format("{}", cells), true)
        .scene.mechanics->cells_per_element = cells;
  for (const double k_Ta : {0.0, 60.0, 100.0, 200.0, 1e3, 1e5})
    cases.one("tension.k_Ta", fmt::format("{:g}", k_Ta), true).scene.tension.k_Ta = k_Ta;
  for (const double p : {-45.0, -30.0, 30.0, 45.0, 60.0, 1e3})
    cases.one("mechanics.p", fmt::format("{:g}", p), true).scene.mechanics->p = p;
  cases.one("mechanics.c2", "0", true).scene.mechanics->c2 = 0;
  for (const double c2 : {0.01, 1e3})
    cases.one("mechanics.c2", fmt::format("{:g}", c2), true).scene.mechanics->c2 = c2;
  cases.one("feedback.metric", "expanded", true).scene.metric = MetricForm::expanded;
  cases.one("mechanics.edges", "fixed", true).scene.mechanics->edges = Edges::fixed;
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

MapTable make_parameters(const MapProgress& progress) {
  Cases cases;
  add_excitation(cases);
  add_stimuli(cases);
  add_steps_and_sheets(cases);
  add_mechanics(cases);
  MapTable table{
      .name = "parameters",
      .caption =
          "A front on a small sheet for 10 t.u., rigid and contracting, one parameter at an end of its "
          "range. "
          "Right: V and r end within a tenth of the same run with an eighth of the step.",
      .columns =
          {{"parameter", ""}, {"value", ""}, {"sheet", ""}, {"error", ""}, {"largest_V", ""}, {"reason", ""}},
      .outcomes = {"right", "refused with the bound", "stopped with a reason", "wrong, with a warning",
                   "finite but wrong"},
      .rows = {},
      .findings = {},
      .view = {}};
  for (const auto& one : cases.cases) {
    const ParameterResult result = run_case(one);
    const bool ran =
        result.outcome != ParameterOutcome::refused && result.outcome != ParameterOutcome::stopped;
    table.rows.push_back({.cells = {one.what, one.value, one.scene.mechanics ? "contracting" : "rigid",
                                    ran ? MapCell(result.error) : MapCell(),
                                    ran ? MapCell(result.largest_V) : MapCell(), one_line(result.reason)},
                          .outcome = static_cast<std::size_t>(result.outcome),
                          .handled = result.outcome != ParameterOutcome::wrong});
    progress(static_cast<double>(table.rows.size()) / static_cast<double>(cases.cases.size()));
  }
  return table;
}

namespace {

// Keeps sum of M_i V_i of the first and the last frame.
class SumOfFrames final : public OutputSink {
 public:
  SumOfFrames(int cells, double dx) : cells_(cells), dx_(dx) {}
  bool wants_fields() const override { return true; }
  void fields(const Frame& frame) override {
    (seen_ ? sum.after : sum.before) = weighted_sum(frame);
    seen_ = true;
  }

  ConservedSum sum;

 private:
  // A quarter of the area of each FD cell goes to each of its corners.
  double weighted_sum(const Frame& frame) const {
    const elastic::ElementGrid elements{frame.element_rows, frame.element_columns, cells_ * dx_};
    const Nodes<Kokkos::HostSpace> nodes("myowave::solver::map_nodes", elements.nodes());
    std::ranges::copy(frame.nodes, nodes.data());
    const auto V = [&](int i, int j) { return frame.V[static_cast<std::size_t>(i) * frame.columns + j]; };
    double total = 0;
    for (int i = 0; i + 1 < frame.rows; ++i)
      for (int j = 0; j + 1 < frame.columns; ++j) {
        const auto element = elastic::element_nodes(elements, nodes, i / cells_, j / cells_);
        const double J = determinant(elastic::deformation_gradient(element, (j % cells_ + 0.5) / cells_,
                                                                   (i % cells_ + 0.5) / cells_, elements.h));
        total += 0.25 * J * (V(i, j) + V(i, j + 1) + V(i + 1, j) + V(i + 1, j + 1));
      }
    return total;
  }

  int cells_;
  double dx_;
  bool seen_ = false;
};

Scene long_scene(Precision precision, int n, std::int64_t steps) {
  Scene scene;
  scene.grid = {n, n, 0.6};
  scene.precision = precision;
  scene.time.t_end = static_cast<double>(steps) * scene.time.dt;
  scene.output.every = scene.output.tips_every = scene.time.t_end;
  return scene;
}

}  // namespace

ConservedSum diffuse_on_held_sheet(Precision precision, int n, std::int64_t steps) {
  Scene scene = long_scene(precision, n, steps);
  scene.excitation.k = 0;
  scene.tension.eps_below = scene.tension.eps_above = 0;
  scene.mechanics.emplace();
  scene.mechanics->cells_per_element = (n - 1) / 2;
  scene.mechanics->interval = static_cast<int>(steps + 1);
  InitialState state = make_initial_state(scene);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto node = static_cast<std::size_t>(i) * n + j;
      state.V[node] = (i * 7 + j * 3) % 11 / 11.0;
      state.Ta[node] = i + 2 * j < n ? scene.tension.k_Ta : 0;
    }
  SumOfFrames sink(scene.mechanics->cells_per_element, scene.grid.dx);
  RunSummary summary;
  run(scene, std::move(state), sink, summary);
  return sink.sum;
}

RestingSheet leave_alone(Precision precision, int n, std::int64_t steps) {
  Scene scene = long_scene(precision, n, steps / 10);
  scene.initial.type = InitialSettings::Type::broken_front;
  OutputSink nowhere;
  RestingSheet sheet{.state = make_initial_state(scene)};
  for (int tenth = 0; tenth < 10; ++tenth) {
    RunSummary summary;
    sheet.state = run(scene, std::move(sheet.state), nowhere, summary);
    (tenth == 0 ? sheet.first_s : sheet.last_s) = summary.wall_s;
  }
  return sheet;
}

namespace {

constexpr int long_side = 9;  // nodes: 2 x 2 elements
constexpr std::int64_t long_steps = 1'000'000;

// Largest relative drift of the sum that rounding alone explains, in units of the last place.
double tolerated_drift(Precision precision) {
  constexpr double places = 100;  // a tenth of this is found
  return places * (precision == Precision::float32 ? FLT_EPSILON : DBL_EPSILON);
}

bool all_normal(const std::vector<double>& values, Precision precision) {
  const double least = precision == Precision::float32 ? double(FLT_MIN) : DBL_MIN;
  return std::ranges::all_of(values, [&](double value) { return value == 0 || std::abs(value) >= least; });
}

}  // namespace

MapTable make_long_runs(const MapProgress& progress) {
  MapTable table{
      .name = "long_runs",
      .caption =
          "A million steps on 9 x 9 nodes: the sum of M V of pure diffusion on a held, deformed "
          "sheet, and a sheet that comes to rest.",
      .columns = {{"what", ""}, {"precision", ""}, {"steps", ""}, {"drift", ""}, {"largest_V", ""}},
      .outcomes = {"right", "wrong"},
      .rows = {},
      .findings = {},
      .view = {}};
  const auto add = [&](std::vector<MapCell> cells, bool right) {
    table.rows.push_back({.cells = std::move(cells), .outcome = right ? 0u : 1u, .handled = right});
    progress(static_cast<double>(table.rows.size()) / 4);
  };
  for (const auto precision : {Precision::float64, Precision::float32}) {
    const char* name = precision == Precision::float64 ? "float64" : "float32";
    const double drift = diffuse_on_held_sheet(precision, long_side, long_steps).drift();
    add({"sum of M V", name, double(long_steps), drift, MapCell()},
        std::abs(drift) < tolerated_drift(precision));
    const RestingSheet sheet = leave_alone(precision, long_side, long_steps);
    add({"rest", name, double(long_steps), MapCell(), largest(sheet.state.V)},
        all_normal(sheet.state.V, precision) && all_normal(sheet.state.r, precision));
    table.findings.push_back(
        fmt::format("At rest, {}: the last tenth of the steps took {:.2f} of the time of the first.", name,
                    sheet.last_s / sheet.first_s));
  }
  return table;
}

}  // namespace myowave::solver
