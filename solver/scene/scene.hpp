// What one run models, with every default resolved. Times in t.u., lengths in units of the paper
// (dx = 0.6), stresses in kPa. The scene file's schema (apps/input/schema.cpp) documents and validates
// each value; here stands only the data that the solver reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/cell/parameters.hpp"
#include "kernels/elastic/parameters.hpp"
#include "solver/scene/tension_laws.hpp"

namespace myowave::solver {

struct GridSettings {
  int rows = 251;     // nodes along X2
  int columns = 251;  // nodes along X1
  double dx = 0.6;    // node spacing, length units
};

// What ends a run before t_end, at the look that establishes it.
struct StopOn {
  bool breakup = false, death = false;
};

struct TimeSettings {
  double dt = 0.02;         // explicit Euler step, t.u.
  double t_end = 400;       // t.u.
  double ms_per_tu = 10.0;  // display only
  StopOn stop_on{};
};

struct ExcitationSettings : cell::AlievPanfilovParameters<double> {
  double C_m = 1.0;  // membrane capacitance
  double D = 1.0;    // diffusion coefficient, length^2/t.u.
};

enum class Load { follower, dead };
enum class Edges { load, fixed };
enum class MetricForm { none, conservative, expanded };
// Of the sheet whose metric holds from one solve to the next: the last solve's, or extrapolated from the last
// two or three to the middle of the interval.
enum class MetricTime { held, linear, quadratic };
enum class Precision { float64, float32 };
// Of the excitation, kernels/tissue/row_update.hpp.
enum class Scheme { euler, split };
// What a run does where its steps are unstable: end, or go back and take smaller ones.
enum class OnUnstable { stop, substep };

struct MechanicsSettings : elastic::MooneyRivlin {
  int cells_per_element = 10;
  Load load = Load::follower;
  double p = 10.0;  // kN/m, positive stretches
  Edges edges = Edges::load;
  int interval = 80;        // steps between solves
  double tolerance = 1e-8;  // max|R_free| / (10 kPa h)
  bool contraction = true;  // false: Ta does not load the mechanics
};

struct Stimulus {
  // Nodes inside; "all" is the whole sheet.
  enum class Shape { all, disc, block };
  double start = 0;
  double period = 0;  // t.u.; 0: once
  double duration = 1;
  double amplitude = 0;    // I_s, 1/t.u.
  std::int64_t count = 1;  // number of pulses; < 0: without end
  Shape shape = Shape::all;
  std::array<double, 2> center{0, 0};  // disc: column, row
  double radius = 0;                   // disc: in node spacings, nodes at distance <= radius
  std::array<int, 2> columns{0, 0};    // block: first and last, inclusive
  std::array<int, 2> rows{0, 0};
};

struct Precondition {
  double duration = 0;  // t.u.
  bool contraction = false;
  ExcitationSettings excitation;  // the scene's own with this table's overrides
  TensionSettings tension;
};

struct InitialSettings {
  enum class Type { rest, broken_front, settled_spiral, file };
  Type type = Type::rest;
  double dx = 0;  // length units, of the grid that it is made on; 0: the run's
  double width = 5;
  double r0 = 1.5;
  std::array<int, 2> offset{0, 0};           // [columns, rows]
  std::array<int, 2> core_offset{0, 0};      // settled_spiral: core from the middle, [columns, rows]
  std::string file;                          // absolute or relative to the working directory
  std::optional<std::array<int, 2>> window;  // [row0, column0]
  double noise = 0;                          // standard deviation added to V
  std::uint64_t seed = 0;
  std::vector<Precondition> preconditions;
};

struct OutputSettings {
  double every = 1;          // t.u.
  double tips_every = 1;     // t.u.
  double probes_every = 1;   // t.u.
  double from = 0;           // t.u.; before it nothing of `every` is shown
  double watch_every = 0.2;  // t.u., for break-up, death and the paths of tips
  bool frames = false;
  bool fields = false;
  bool element_areas = false;              // no effect in a rigid run
  bool maps = false;                       // of each node's beats
  bool tension = true;                     // Ta is shown, or another run starts from it
  std::vector<std::array<int, 2>> probes;  // (row, column); empty in a file: the four default ones
  double period_from = 100;                // t.u.
  double checkpoint_every = 0;             // t.u.; 0: only where the run is asked to stop
};

struct Scene {
  std::string name;
  GridSettings grid;  // of the run
  TimeSettings time;
  ExcitationSettings excitation;
  TensionSettings tension;
  std::optional<MechanicsSettings> mechanics;    // empty: rigid
  MetricForm metric = MetricForm::conservative;  // no effect without mechanics
  MetricTime metric_time = MetricTime::held;
  InitialSettings initial;
  std::vector<Stimulus> stimuli;
  double dx = 0;  // length units, largest node spacing that the grid was fitted to; 0: the sheet's own
  Precision precision = Precision::float64;
  Scheme scheme = Scheme::euler;
  std::string preset = "none";  // reported only: what it stands for is in the scene's own values
  OnUnstable on_unstable = OnUnstable::stop;
  OutputSettings output;
};

// What the scene requires: the plan tells it (solver/base/plan.hpp), the run computes it.

inline bool contracts(const Scene& scene) { return scene.mechanics && scene.mechanics->contraction; }

// Ta is stored and computed.
inline bool has_tension(const Scene& scene) {
  return scene.tension.law != TensionLaw::none && (contracts(scene) || scene.output.tension);
}

inline bool has_element_areas(const Scene& scene) { return scene.mechanics && scene.output.element_areas; }

// The form of the diffusion term.
inline MetricForm metric_form(const Scene& scene) {
  return scene.mechanics ? scene.metric : MetricForm::none;
}

// Solves whose nodes make the metric of an interval; nodes that stay where they are need no more than one.
inline std::size_t solves_of_metric(const Scene& scene) {
  const bool moves = contracts(scene) && metric_form(scene) != MetricForm::none;
  return moves ? 1 + static_cast<std::size_t>(scene.metric_time) : 1;
}

}  // namespace myowave::solver
