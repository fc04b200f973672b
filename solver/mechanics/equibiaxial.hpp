// The uniform equilibrium of the membrane under uniform tension and edge load.
#pragma once

#include <optional>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// The stretch lambda = sqrt s of the sheet at the tension Ta (kPa):
//
//   2 (s - s^-2)(c1 + c2 s) + Ta = p s (follower) or p sqrt s (dead)
//
// Empty if there is none, as for a follower load with c2 = 0 and p >= 2 c1.
std::optional<double> equibiaxial_stretch(const MechanicsSettings&, double Ta);

}  // namespace myowave::solver
