// Distance of an equilibrium from loss of ellipticity.
#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// The smallest acoustic modulus (kernels/elastic/ellipticity.hpp) over Gauss points and directions, over
// the shear modulus 2 (c1 + c2) of the undeformed sheet: 1 there, 0 where ellipticity is lost, negative
// beyond. Nodes in length units, Ta in kPa, every J positive. Serial.
double ellipticity_margin(const elastic::ElementGrid&, const MechanicsSettings&,
                          const Nodes<Kokkos::HostSpace>&, const GaussTension<Kokkos::HostSpace>& Ta);

}  // namespace myowave::solver
