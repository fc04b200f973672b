// Phase singularities and their trajectories, as a run reports them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace myowave::solver {

// A phase singularity in material coordinates (length units), charge +1 counter-clockwise.
struct Tip {
  double x = 0;
  double y = 0;
  int charge = 0;
  int trajectory = -1;  // -1: none
};

// How a trajectory starts or ends: with the run; together with one of opposite charge; at the edge of the
// sheet; or without a cause nearby.
enum class TipEvent { run, pair, boundary, alone };

// All whole rotations of a tip. A rotation is done when the direction of its motion has turned by 2 pi.
struct TipCore {
  double x = 0, y = 0;  // time mean of the position
  // Mean distance from the mean position of the same rotation. A drift by one radius per rotation makes it a
  // tenth larger.
  double radius = 0;
  std::int64_t rotations = 0;
};

// Straight line of least squares through the mean positions of the rotations against their mean times.
struct TipDrift {
  double speed = 0;      // length units per t.u.
  double direction = 0;  // rad, counter-clockwise from the direction of columns
};

struct TipTrajectory {
  int number = 0;  // from 0 in the order of birth, tips of one instant by row and column
  int charge = 0;
  double birth = 0, death = 0;  // t.u., first and last sample with the tip
  TipEvent born = TipEvent::run, ended = TipEvent::run;
  std::optional<TipCore> core;     // none before one rotation
  std::optional<TipDrift> drift;   // none before two
  std::optional<double> boundary;  // t.u., first sample within ten nodes of an edge
};

struct TrajectoryCounts {
  std::int64_t n = 0;
  std::array<std::int64_t, 4> born{}, ended{};  // by TipEvent
};

}  // namespace myowave::solver
