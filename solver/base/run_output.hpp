// Input and output of a run: states, samples, summary. Without Kokkos, for code that only reads or writes
// them.
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

// Grid fields, row-major (rows, columns); Ta is zero if it is not computed. Nodes (element
// rows + 1, element columns + 1, 2).
struct InitialState {
  int rows = 0;
  int columns = 0;
  std::vector<double> V, r, Ta;
};

// Host copies of the fields at time t; valid only during the call.
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
  int tips = 0;                        // at the last sample
};

// Receives the samples of a run. Called on the host, in time order, at the times that the scene asks for.
class OutputSink {
 public:
  virtual ~OutputSink() = default;
  virtual void fields(const Frame&) {}
  // V0, r0, Ta0, V1, ...; Ta 0 if it is not computed.
  virtual void probes(double /*t*/, std::span<const double>) {}
  virtual void tips(double /*t*/, std::span<const Tip>) {}
  // After the next upstroke; the last beats at the end of the run.
  virtual void beat(const ProbeBeat&) {}
  // After a trajectory has ended; the living ones at the end of the run.
  virtual void trajectory(const TipTrajectory&) {}
  // Relative to the loaded rest state: whole sheet, smallest and largest element.
  virtual void area(double /*t*/, double /*total*/, double /*min*/, double /*max*/) {}
  // Likewise, of each element I (element columns) + J; only if the scene asks for them.
  virtual void element_areas(double /*t*/, std::span<const double>) {}
  // At the end, if the scene asks for them.
  virtual void maps(const ActivationMaps&) {}
  virtual void progress(const Progress&) {}
  // As soon as the problem is found; RunSummary::warnings has all of them too.
  virtual void warning(const std::string&) {}
  // What the sink itself needs to continue its outputs from here (solver/run/checkpoint.hpp). The outputs up
  // to the mark are safe on the disk.
  virtual std::string mark() { return {}; }
  // True: fields() is wanted at `every` (it costs a copy to the host).
  virtual bool wants_fields() const { return false; }
};

struct PhaseSeconds {
  double excitation = 0, transfer = 0, mechanics = 0, observe = 0, output = 0;
};

struct MechanicsStatistics {
  std::int64_t solves = 0;
  std::int64_t left_out = 0;  // skipped, because no tension had changed since the last solve
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
  std::optional<Quartiles> conduction_velocity;  // over the nodes, length units / t.u.; if there are maps
  std::optional<double> breakup_tu, death_tu;
  std::optional<std::pair<double, double>> area;        // min, max
  std::optional<std::pair<double, double>> shortening;  // largest, at t
};

struct RunSummary {
  Plan plan;               // what is modelled
  std::int64_t steps = 0;  // taken
  double t = 0;            // reached
  PhaseSeconds phases;     // of the scene itself, without preconditions
  double wall_s = 0;       // likewise
  double precondition_s = 0;
  double cell_steps_per_s = 0;  // nodes * steps / wall_s
  MechanicsStatistics mechanics;
  // Steps that were divided into substeps, also in preconditions, and the largest number of substeps.
  std::int64_t substepped_steps = 0, largest_substeps = 1;
  std::vector<std::string> warnings;
  // Largest at any time; empty if it was not watched (solver/run/memory_watch.hpp).
  std::vector<SpaceBytes> memory;
  Observables observables;
};

}  // namespace myowave::solver
