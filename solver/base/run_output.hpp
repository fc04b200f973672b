// What a run begins from and what it gives: states, samples, summary. Without Kokkos, for what only reads or
// writes them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "solver/base/activation_maps.hpp"
#include "solver/base/beat.hpp"
#include "solver/base/plan.hpp"
#include "solver/base/run_stage.hpp"
#include "solver/base/sample_statistics.hpp"
#include "solver/base/tips.hpp"

namespace myowave::solver {

// Grid fields, row-major (rows, columns); Ta is zero where it is not computed. Nodes (element
// rows + 1, element columns + 1, 2).
struct InitialState {
  int rows = 0;
  int columns = 0;
  std::vector<double> V, r, Ta;
};

// Host copies of what is shown at time t; valid only during the call.
struct Frame {
  double t = 0;  // t.u.
  int rows = 0;
  int columns = 0;
  int element_rows = 0;  // 0 in a rigid run
  int element_columns = 0;
  std::span<const double> V, r, Ta;  // rows * columns
  std::span<const double>
      nodes;  // (element_rows+1) * (element_columns+1) * 2, x1 then x2; empty in a rigid run
};

struct Progress {
  double t = 0;
  double t_end = 0;
  RunStage stage;
  double cell_steps_per_s = 0;
  std::int64_t newton_iterations = 0;  // in total
  int tips = 0;                        // at the last look
};

// Where samples go. Called on the host, in time order, each at the instants the scene asks for.
class OutputSink {
 public:
  virtual ~OutputSink() = default;
  virtual void fields(const Frame&) {}
  // V0, r0, Ta0, V1, ...; Ta 0 where it is not computed.
  virtual void probes(double /*t*/, std::span<const double>) {}
  virtual void tips(double /*t*/, std::span<const Tip>) {}
  // Once the upstroke after it has come, those that the run ends at its end.
  virtual void beat(const ProbeBeat&) {}
  // Once a trajectory has ended, those that the run ends at its end.
  virtual void trajectory(const TipTrajectory&) {}
  // Relative to the loaded rest state: whole sheet, smallest and largest element.
  virtual void area(double /*t*/, double /*total*/, double /*min*/, double /*max*/) {}
  // Likewise, of each element I (element columns) + J; only where the scene asks for them.
  virtual void element_areas(double /*t*/, std::span<const double>) {}
  // At the end, where the scene asks for them.
  virtual void maps(const ActivationMaps&) {}
  virtual void progress(const Progress&) {}
  // At the time that the run comes to know; all stand in RunSummary::warnings too.
  virtual void warning(const std::string&) {}
  // What it needs to go on with its outputs from here, for its own use (solver/run/checkpoint.hpp). What it
  // speaks of is safe on the disk.
  virtual std::string mark() { return {}; }
  // True: fields() is wanted at `every` (it costs a copy to the host).
  virtual bool wants_fields() const { return false; }
};

struct PhaseSeconds {
  double excitation = 0, transfer = 0, mechanics = 0, observe = 0, output = 0;
};

struct MechanicsStatistics {
  std::int64_t solves = 0;
  std::int64_t left_out = 0;  // were due, but no tension had changed since the last one
  std::int64_t newton_iterations = 0, newton_max = 0, factorizations = 0, shifts = 0;
  std::int64_t not_elliptic = 0;  // solves with a Gauss point where ellipticity is lost
  double min_J = 1;               // smallest at any corner of any element over all accepted solutions
};

struct Observables {
  // Of the beats at probes, t.u.: to the next upstroke, V > 0.1, and to 90 % repolarisation.
  MeanSd period, apd, apd90;
  SeriesStatistics tips;  // number of them at output.tips_every
  std::optional<double> tips_correlation_tu;
  TrajectoryCounts trajectories;
  std::optional<TipTrajectory> longest_trajectory;
  std::optional<Quartiles> conduction_velocity;  // over the nodes, length units / t.u.; where there are maps
  std::optional<double> breakup_tu, death_tu;
  std::optional<std::pair<double, double>> area;        // min, max
  std::optional<std::pair<double, double>> shortening;  // largest, at t
};

struct RunSummary {
  Plan plan;               // what is modelled
  std::int64_t steps = 0;  // done
  double t = 0;            // reached
  PhaseSeconds phases;     // of the scene itself, preconditions apart
  double wall_s = 0;       // likewise
  double precondition_s = 0;
  double cell_steps_per_s = 0;  // nodes * steps / wall_s
  MechanicsStatistics mechanics;
  // Steps that were taken in parts, preconditions too, and the largest number of parts.
  std::int64_t substepped_steps = 0, largest_substeps = 1;
  std::vector<std::string> warnings;
  // The most at once; empty where it was not watched (solver/run/memory_watch.hpp).
  std::vector<SpaceBytes> memory;
  Observables observables;
};

}  // namespace myowave::solver
