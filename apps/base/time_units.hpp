// Time of the paper's scenes.
#pragma once

namespace myowave::apps {

// 1 t.u. of the paper's rescaled time.
inline constexpr double ms_per_tu = 10;
inline constexpr double to_seconds(double tu) { return tu * ms_per_tu / 1000; }

}  // namespace myowave::apps
