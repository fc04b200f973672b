// Deformed and active sheets for the tests of the mechanics.
#pragma once

#include <Kokkos_Core.hpp>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"
#include "kernels/elastic/kinematics.hpp"

namespace myowave::test {

// Uniform in [0, 1), the same numbers on every platform.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double operator()(double low, double high) { return low + (high - low) * (*this)(); }

 private:
  std::mt19937_64 engine_;
};

// Undeformed nodes displaced by at most `amount` of the edge length each way, no element inverted
// for amounts below 0.2.
template <class MemorySpace>
Nodes<MemorySpace> rough_nodes(const elastic::ElementGrid& grid, double amount, std::uint64_t seed) {
  Nodes<MemorySpace> nodes("nodes", grid.nodes());
  const auto host = Kokkos::create_mirror_view(nodes);
  Uniform uniform(seed);
  for (int I = 0; I <= grid.rows; ++I) {
    for (int J = 0; J <= grid.columns; ++J) {
      host(grid.node(I, J), 0) = grid.h * (J + uniform(-amount, amount));
      host(grid.node(I, J), 1) = grid.h * (I + uniform(-amount, amount));
    }
  }
  Kokkos::deep_copy(nodes, host);
  return nodes;
}

// Tension from a function of the position (xi_1, xi_2) in element edges.
template <class MemorySpace, class Function>
GaussTension<MemorySpace> tension_from(const elastic::ElementGrid& grid, const Function& tension) {
  GaussTension<MemorySpace> Ta("Ta", grid.elements());
  const auto host = Kokkos::create_mirror_view(Ta);
  for (int e = 0; e < grid.elements(); ++e) {
    for (int q = 0; q < elastic::gauss_points; ++q) {
      host(e, q) = tension(e % grid.columns + elastic::gauss_coordinate(q % 2),
                           e / grid.columns + elastic::gauss_coordinate(q / 2));
    }
  }
  Kokkos::deep_copy(Ta, host);
  return Ta;
}

// Many rotating fronts, each around the nearest of some random centres: tension between 0 and
// `largest` kPa, steep within an element. `turn` in rotations.
template <class MemorySpace>
GaussTension<MemorySpace> many_fronts(const elastic::ElementGrid& grid, double largest, std::uint64_t seed,
                                      double turn = 0) {
  struct Spiral {
    double x, y, phase, wavelength;
  };
  Uniform uniform(seed);
  std::vector<Spiral> spirals(grid.elements() / 60 + 1);
  for (auto& s : spirals) {
    s = {uniform(0, grid.columns), uniform(0, grid.rows), uniform(0, 2 * std::numbers::pi), uniform(3, 8)};
  }
  return tension_from<MemorySpace>(grid, [&](double x, double y) {
    double nearest = 1e300, tension = 0;
    for (const auto& s : spirals) {
      const double distance = std::hypot(x - s.x, y - s.y);
      if (distance >= nearest) continue;
      nearest = distance;
      const double phase =
          2 * std::numbers::pi * (distance / s.wavelength - turn) + std::atan2(y - s.y, x - s.x) + s.phase;
      tension = largest * (0.5 + 0.5 * std::tanh(3 * std::sin(phase)));
    }
    return tension;
  });
}

}  // namespace myowave::test
