// The sheets that the rows compute on: fields with waves, a deformed mesh, the tension of turbulence.
#pragma once

#include <Kokkos_Core.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bench/suite.hpp"
#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"
#include "kernels/tissue/grid.hpp"
#include "solver/excitation/select_model.hpp"
#include "solver/run/run.hpp"

namespace myowave::bench {

inline constexpr int cells_per_element = 10;
inline constexpr double dx = 0.6;   // length units
inline constexpr double dt = 0.02;  // t.u.

inline tissue::Grid square_grid(int n) { return {n, n, dx}; }
inline elastic::ElementGrid square_elements(int n) {
  return {(n - 1) / cells_per_element, (n - 1) / cells_per_element, cells_per_element * dx};
}

// A value of the initial state at node (i, j): smooth, no symmetry, in the range of the model.
inline double initial_V(int i, int j) { return 0.5 + 0.5 * std::sin(0.11 * i + 0.3) * std::cos(0.07 * j); }
inline double initial_r(int i, int j) { return 0.8 + 0.7 * std::cos(0.05 * i) * std::sin(0.09 * j + 1); }
inline double initial_Ta(int i, int j) { return 8 + 7 * std::sin(0.04 * i - 0.06 * j); }

template <class View, class Value>
void fill(const View& view, const Value& value) {
  const auto host = Kokkos::create_mirror_view(view);
  Kokkos::parallel_for("myowave::bench::fill",
                       Kokkos::MDRangePolicy<Kokkos::DefaultHostExecutionSpace, Kokkos::Rank<2>>(
                           {0, 0}, {static_cast<int>(view.extent(0)), static_cast<int>(view.extent(1))}),
                       [&](int m, int i) {
                         for (int j = 0; j < static_cast<int>(view.extent(2)); ++j)
                           host(m, i, j) = value(i, j);
                       });
  Kokkos::fence("myowave::bench::fill");
  Kokkos::deep_copy(view, host);
}

// Element nodes (x1, x2 of node 0, of node 1, ...): sheared, stretched one way, contracted the other,
// and bent, so that F jumps between elements.
inline std::vector<double> deformed_nodes(const elastic::ElementGrid& grid) {
  std::vector<double> x;
  for (int I = 0; I <= grid.rows; ++I)
    for (int J = 0; J <= grid.columns; ++J) {
      const double X1 = J * grid.h, X2 = I * grid.h;
      x.push_back(1.1 * X1 + 0.1 * X2 + 0.08 * grid.h * std::sin(1.7 * I + 0.9 * J));
      x.push_back(0.9 * X2 - 0.05 * X1 + 0.08 * grid.h * std::cos(1.3 * J - 0.8 * I));
    }
  return x;
}

inline Nodes<MemorySpace> to_nodes(const std::vector<double>& x) {
  const Nodes<MemorySpace> nodes("myowave::bench::nodes", x.size() / 2);
  Kokkos::deep_copy(
      nodes, Kokkos::View<const double* [2], Kokkos::LayoutRight, Kokkos::HostSpace>(x.data(), x.size() / 2));
  return nodes;
}

template <class View>
std::vector<double> to_host(const View& view) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
  return {host.data(), host.data() + host.size()};
}

// A turbulent sheet of n x n nodes without contraction, for n = 10 elements + 1; computed once.
const solver::InitialState& turbulent_state(int n);

// Its tension at the Gauss points (elements, 4), at instants 80 steps apart; computed once.
const std::vector<std::vector<double>>& turbulent_tension(int elements_a_side);

// The excitation of both.
solver::ExcitationSettings turbulent_excitation();

GaussTension<MemorySpace> to_gauss_tension(const std::vector<double>& values);

}  // namespace myowave::bench
