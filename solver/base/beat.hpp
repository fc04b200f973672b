// An action potential at a node, and the levels of V that define it.
#pragma once

#include <cstddef>
#include <limits>

namespace myowave::solver {

// Probes and activation maps use the same levels.
struct BeatLevels {
  static constexpr double upstroke = 0.5;        // V of the upstroke
  static constexpr double rearm = 0.2;           // V has to fall below it before the next upstroke
  static constexpr double apd = 0.1;             // V of Beat::apd
  static constexpr double repolarisation = 0.9;  // fraction of the amplitude, of Beat::apd90
};

// An action potential at a point. Times in t.u., nan if unknown.
struct Beat {
  double upstroke = 0;                                       // V = 0.5
  double period = std::numeric_limits<double>::quiet_NaN();  // to the next upstroke
  double apd = std::numeric_limits<double>::quiet_NaN();     // V > 0.1
  double apd90 =
      std::numeric_limits<double>::quiet_NaN();  // upstroke to 90 % repolarisation of its own amplitude
  double di = std::numeric_limits<double>::quiet_NaN();  // diastolic interval after it: period - apd90
};

struct ProbeBeat {
  std::size_t probe = 0;
  Beat beat;
};

}  // namespace myowave::solver
