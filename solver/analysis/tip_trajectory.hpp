// Trajectories of phase singularities: links the tips of successive samples and measures birth, end, core and
// drift of each trajectory.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "solver/base/tips.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Rotations of one tip. Stores the points of the current rotation.
class RotationMeter {
 public:
  // step: the direction is that of straight lines at least so long, which the uncertainty of a tip's place, a
  // small part of the node spacing, does not turn.
  explicit RotationMeter(double step) : step_(step) {}

  // In time order, at intervals much shorter than a rotation.
  void add(double t, double x, double y);

  std::optional<TipCore> core() const;
  std::optional<TipDrift> drift() const;

  template <class Archive>
  void state(Archive& archive) {
    archive(points_, corner_, heading_, heading_time_, turned_, sums_, points_in_rotations_, first_, sum_t_,
            sum_tt_, sum_x_, sum_y_, sum_tx_, sum_ty_);
  }

 private:
  struct Point {
    double t, x, y;
  };
  void turn(const Point&);
  void end_rotation(double t);

  static constexpr double full_turn = 2 * std::numbers::pi;

  double step_;
  std::vector<Point> points_;    // since the start of this rotation
  std::optional<Point> corner_;  // start of the next line
  // Of the last line; its time is that of its middle.
  std::optional<double> heading_;
  double heading_time_ = 0, turned_ = 0;
  TipCore sums_;  // of positions and distances over all points of whole rotations
  std::int64_t points_in_rotations_ = 0;
  // Means of rotations, relative to those of the first.
  std::optional<Point> first_;
  double sum_t_ = 0, sum_tt_ = 0, sum_x_ = 0, sum_y_ = 0, sum_tx_ = 0, sum_ty_ = 0;
};

// How far a tip can have moved in a time (t.u.): twice as far as the fastest front, a (the threshold) = 0 in
// sqrt(k D / 2) (1 - 2 a) / C_m, and 2.5 front widths sqrt(8 D / k) or four nodes beside, over which a
// singularity slides at once when a front meets a back. Of 19000 links 0.2 t.u. apart in turbulence, rigid
// and contracting, the longest is 2.4 at dx = 0.6, where this is 3.3.
double gating_distance(const Scene&, double interval);

// Links tips of the same charge, nearest first, so that the order of the tips does not matter. Births and
// ends of the others are, nearest first too: a pair, if two of opposite charge are within twice the gating
// distance; at the boundary, if that is within the gating distance; else alone. A sample without the tip is
// not bridged, because this is not needed: of the 152 trajectories of the two runs above none ended alone,
// and 3 were born alone, where V = 0.5 and dV/dt = 0 touched along a line.
class TipTrajectories {
 public:
  static constexpr int boundary_nodes = 10;

  // Holds a reference to the scene.
  explicit TipTrajectories(const Scene&);

  // Tips at t, in time order. Assigns them to trajectories.
  void add_sample(double t, std::span<Tip> tips);
  // Call after the last sample: ends all living trajectories.
  void finish();

  // Trajectories that ended since the last call.
  std::vector<TipTrajectory> take_ended();
  const TrajectoryCounts& counts() const { return counts_; }
  // Of the ended trajectories.
  const std::optional<TipTrajectory>& longest() const { return longest_; }

  template <class Archive>
  void state(Archive& archive) {
    std::size_t living = live_.size();
    archive(living, last_sample_, next_number_, ended_, counts_, longest_);
    if constexpr (Archive::loads) live_.assign(living, new_live());
    for (auto& live : live_) archive(live.trajectory, live.tip, live.rotations);
  }

 private:
  struct Live {
    TipTrajectory trajectory;
    Tip tip;  // at the last sample
    RotationMeter rotations;
  };
  Live new_live() const { return {{}, {}, RotationMeter(scene_.grid.dx)}; }
  double to_edge(const Tip&) const;
  std::vector<TipEvent> explain(const std::vector<Tip>&, double reach) const;
  void follow(Live&, double t, Tip&);
  void end(const Live&, TipEvent);

  const Scene& scene_;
  std::vector<Live> live_;  // by row and column of the tip
  std::optional<double> last_sample_;
  int next_number_ = 0;
  std::vector<TipTrajectory> ended_;
  TrajectoryCounts counts_;
  std::optional<TipTrajectory> longest_;
};

}  // namespace myowave::solver
