// What is measured of the sheet's area at a solve of the mechanics.
#pragma once

namespace myowave::solver {

// Areas of the sheet at one solve. Ratios are to the loaded rest state.
struct AreaSample {
  double t = 0;
  double ratio = 1, min_ratio = 1, max_ratio = 1;
  double shortening = 0;  // 1 - sqrt(area / undeformed area)
};

}  // namespace myowave::solver
