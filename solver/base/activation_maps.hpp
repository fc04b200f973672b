// Beats of each node, as a run reports them.
#pragma once

#include <vector>

namespace myowave::solver {

// Row-major (rows, columns). Times in t.u.; nan if there is none.
struct ActivationMaps {
  // t.u. between two samples of V. With linear interpolation the upstroke of a plane wave is off by at most
  // 0.007.
  static constexpr double sample_every = 0.4;

  int rows = 0, columns = 0;
  double dx = 0;                                     // length units
  double apd_level = 0;                              // V
  std::vector<double> activation, first_activation;  // the last and the first upstroke, V = 0.5
  std::vector<double> period, period_sd;             // of the beats from output.period_from on
  std::vector<double> apd;                  // likewise, from activation until V falls through apd_level
  std::vector<int> beats;                   // upstrokes in the whole run
  std::vector<double> conduction_velocity;  // of the last activation, length units / t.u.
};

}  // namespace myowave::solver
