// Fields and nodes between row-major std::vector and Views, and what the kernels are tested on.
#pragma once

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"
#include "kernels/tissue/grid.hpp"
#include "tests/support/reference_mechanics.hpp"

namespace myowave::test {

using ExecutionSpace = Kokkos::DefaultExecutionSpace;
using MemorySpace = ExecutionSpace::memory_space;
using Values = std::vector<double>;

// One field a member, each of shape (rows, columns).
template <class Real>
EnsembleField<Real, MemorySpace> to_view(int rows, int columns, const std::vector<Values>& members) {
  const EnsembleField<Real, MemorySpace> view("myowave::test::field", members.size(), rows, columns);
  const auto host = Kokkos::create_mirror_view(view);
  Real* next = host.data();
  for (const Values& values : members)
    next = std::transform(values.begin(), values.end(), next, [](double v) { return static_cast<Real>(v); });
  Kokkos::deep_copy(view, host);
  return view;
}

template <class View>
Values to_values(const View& view, int member = 0) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
  const std::size_t size = view.size() / view.extent(0);
  return {host.data() + member * size, host.data() + (member + 1) * size};
}

// Nodes as reference::undeformed() lists them.
inline Nodes<MemorySpace> to_nodes(const Values& x) {
  const Nodes<MemorySpace> nodes("myowave::test::nodes", x.size() / 2);
  const auto host = Kokkos::create_mirror_view(nodes);
  std::copy(x.begin(), x.end(), host.data());
  Kokkos::deep_copy(nodes, host);
  return nodes;
}

// A grid with the elements that cover it.
struct Sheet {
  int rows, columns, cells;  // cells an element, each way
  double dx = 0.6;

  int size() const { return rows * columns; }
  tissue::Grid grid() const { return {rows, columns, dx}; }
  elastic::ElementGrid elements() const { return {(rows - 1) / cells, (columns - 1) / cells, cells * dx}; }
  reference::Grid reference_grid() const { return {rows, columns, dx}; }
  reference::Mesh mesh() const { return {(rows - 1) / cells, (columns - 1) / cells, cells * dx}; }
};

// Independent uniform values at every node.
inline Values random_field(int size, double low, double high, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(low, high);
  Values values(size);
  for (double& v : values) v = uniform(engine);
  return values;
}

// Twelve random plane waves of at least eight node spacings, mean zero, values of order one.
inline Values smooth_random_field(int rows, int columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr double largest_wave_number = 2 * std::numbers::pi / 8;
  Values values(static_cast<std::size_t>(rows) * columns);
  for (int wave = 0; wave < 12; ++wave) {
    const double angle = std::numbers::pi * uniform(engine), phase = std::numbers::pi * uniform(engine);
    const double k = largest_wave_number * std::abs(uniform(engine)), amplitude = 0.4 * uniform(engine);
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j)
        values[static_cast<std::size_t>(i) * columns + j] +=
            amplitude * std::cos(k * (std::cos(angle) * j + std::sin(angle) * i) + phase);
  }
  return values;
}

using Map = std::function<std::array<double, 2>(double, double)>;

inline Values mapped(const reference::Mesh& mesh, const Map& map) {
  Values x = reference::undeformed(mesh);
  for (int n = 0; n < mesh.nodes(); ++n) {
    const auto [x1, x2] = map(x[2 * n], x[2 * n + 1]);
    x[2 * n] = x1;
    x[2 * n + 1] = x2;
  }
  return x;
}

// Sheared, turned, stretched one way and contracted the other, every node displaced at random by up
// to 0.15 of an edge: no symmetry, and F jumps between elements. J > 0 at every corner.
inline Values crumpled(const reference::Mesh& mesh, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> displacement(-0.15 * mesh.h, 0.15 * mesh.h);
  return mapped(mesh, [&](double X1, double X2) {
    return std::array{1.2 * X1 + 0.3 * X2 + displacement(engine),
                      -0.2 * X1 + 0.85 * X2 + displacement(engine)};
  });
}

}  // namespace myowave::test
