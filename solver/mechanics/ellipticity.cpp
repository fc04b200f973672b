#include "solver/mechanics/ellipticity.hpp"

#include <algorithm>
#include <limits>

#include "kernels/elastic/element.hpp"
#include "kernels/elastic/ellipticity.hpp"

namespace myowave::solver {

double ellipticity_margin(const elastic::ElementGrid& grid, const MechanicsSettings& settings,
                          const Nodes<Kokkos::HostSpace>& nodes, const GaussTension<Kokkos::HostSpace>& Ta) {
  const elastic::Membrane unloaded{.passive = settings, .load = {}};
  double least = std::numeric_limits<double>::infinity();
  for (int e = 0; e < grid.elements(); ++e) {
    const auto element = elastic::element_nodes(grid, nodes, e);
    for (int q = 0; q < elastic::gauss_points; ++q) {
      const Mat2 F = elastic::gauss_deformation_gradient(element, q, grid.h);
      const auto tangent = elastic::spatial_tangent(elastic::membrane_energy(unloaded, Ta(e, q), F), F);
      least = std::min(least, elastic::least_acoustic_modulus(tangent));
    }
  }
  return least / (2 * (settings.c1 + settings.c2));
}

}  // namespace myowave::solver
