// Whether the loaded sheet has a stable equilibrium without tension: all areas refer to it, every
// solve leads back to it, and where there is none an iteration ends in whatever the pins hold.
#pragma once

#include <optional>
#include <string>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// The largest dead load, kN/m, under which the sheet at rest is stable; infinite where c2 = 0. Above,
// equal loads on its sides stretch it more one way than the other (Kearsley 1986): at w_aa = w_ab for the
// stretches a = b = sqrt s, which is c1 (1 + s^-3) + c2 (3 s^-2 - s) = 0.
double largest_dead_load(const MechanicsSettings&);

// What leaves the sheet without a stable rest state, with the bound; empty where it has one.
//
// Follower: Pi has no lower bound where c2 = 0 and p >= 2 c1. Dead: with p < 0 the sheet turned by 180
// degrees has less energy, and no rotation on the way resists.
std::optional<std::string> why_no_rest_state(const MechanicsSettings&);

}  // namespace myowave::solver
