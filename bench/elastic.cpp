// Assembly and energies of the elements:   elastic / assemble|energies / elements a side
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "solver/mechanics/mesh.hpp"
#include "solver/mechanics/sparse_system.hpp"
#include "tests/support/reference_mechanics.hpp"

namespace myowave::bench {
namespace {

constexpr int small_mesh = 12;

// Different at every Gauss point, kPa.
std::vector<double> some_tension(const elastic::ElementGrid& grid) {
  std::vector<double> Ta;
  for (int e = 0; e < grid.elements(); ++e)
    for (int q = 0; q < elastic::gauss_points; ++q) Ta.push_back(initial_Ta(5 * e, 7 * q));
  return Ta;
}

elastic::ElementGrid mesh_of(int elements) { return square_elements(cells_per_element * elements + 1); }

elastic::Membrane membrane() {
  const solver::MechanicsSettings settings;
  return {.passive = settings, .load = {.follower = settings.p}};
}

// Empty if the residual of the assembled system equals the reference's.
std::string check_residual(const solver::SparseSystem<ExecutionSpace>& system,
                           const elastic::ElementGrid& grid, const std::vector<double>& x,
                           const std::vector<double>& Ta) {
  const auto expected = reference::residual({grid.rows, grid.columns, grid.h}, {}, Ta, x);
  const auto& nodal = system.nodal_residual();
  for (std::size_t a = 0; a < expected.size(); ++a)
    if (!(std::abs(nodal(a / 2, a % 2) - expected[a]) <= 1e-10 * (1 + std::abs(expected[a]))))
      return fmt::format("the residual of node {} is {} and should be {}", a / 2, nodal(a / 2, a % 2),
                         expected[a]);
  return {};
}

void time_assemble(benchmark::State& state, const Suite& suite, int elements) {
  const auto grid = mesh_of(elements);
  const auto x = deformed_nodes(grid), tension = some_tension(grid);
  const auto nodes = to_nodes(x);
  const auto Ta = to_gauss_tension(tension);
  solver::SparseSystem<ExecutionSpace> system(ExecutionSpace(), solver::make_mesh(grid, solver::Edges::load));
  const double seconds = measure(state, batch_of(100.0 * grid.elements()),
                                 [&] { system.assemble(ExecutionSpace(), membrane(), grid, nodes, Ta); });
  report(state, suite, seconds, "elements_per_s", grid.elements(), assemble_traffic,
         suite.float64_flops_per_s);
  const std::string wrong = check_residual(system, grid, x, tension);
  if (!wrong.empty()) fail(state, wrong);
}

void time_energies(benchmark::State& state, const Suite& suite, int elements) {
  const auto grid = mesh_of(elements);
  const auto x = deformed_nodes(grid), tension = some_tension(grid);
  const auto nodes = to_nodes(x);
  const auto Ta = to_gauss_tension(tension);
  const elastic::Rows<MemorySpace> energy("myowave::bench::energy", 2, grid.elements());
  const double seconds = measure(state, batch_of(50.0 * grid.elements()), [&] {
    elastic::element_energies(ExecutionSpace(), membrane(), grid, nodes, Ta, energy);
  });
  report(state, suite, seconds, "elements_per_s", grid.elements(), energy_traffic, suite.float64_flops_per_s);
  const auto found = to_host(energy);
  const double sum = std::accumulate(found.begin(), found.begin() + grid.elements(), 0.0);
  const double expected = reference::energy({grid.rows, grid.columns, grid.h}, {}, tension, x);
  if (!(std::abs(sum - expected) <= 1e-10 * std::abs(expected)))
    fail(state, fmt::format("the energy is {} and should be {}", sum, expected));
}

}  // namespace

void register_elastic(const Suite& suite) {
  for (const int elements : suite.sizes({12, 25, 50, 100, 250}, small_mesh)) {
    add_row(fmt::format("elastic/assemble/{}", elements),
            [=](benchmark::State& state) { time_assemble(state, suite, elements); });
    add_row(fmt::format("elastic/energies/{}", elements),
            [=](benchmark::State& state) { time_energies(state, suite, elements); });
  }
}

}  // namespace myowave::bench
