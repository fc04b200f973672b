// Transfer between grid and elements:
//   transfer / tension | conservative | expanded / float64|float32 / n
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "bench/plain/step.hpp"
#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "kernels/transfer/tension_to_gauss.hpp"
#include "tests/support/reference_mechanics.hpp"

namespace myowave::bench {
namespace {

constexpr int small_n = 121;

template <class Real>
constexpr double tolerance = sizeof(Real) == sizeof(double) ? 1e-12 : 1e-5;

template <class Real>
void time_tension(benchmark::State& state, const Suite& suite, int n) {
  const auto elements = square_elements(n);
  const EnsembleField<Real, MemorySpace> Ta("myowave::bench::Ta", 1, n, n);
  fill(Ta, [](int i, int j) { return static_cast<Real>(initial_Ta(i, j)); });
  const GaussTension<MemorySpace> gauss("myowave::bench::gauss_tension", elements.elements());
  const double seconds = measure(state, batch_of(20.0 * elements.elements()), [&] {
    transfer::tension_to_gauss<ExecutionSpace, Real>(ExecutionSpace(), elements, cells_per_element, Ta, 0,
                                                     gauss);
  });
  report(state, suite, seconds, "elements_per_s", elements.elements(), tension_traffic<Real>(),
         suite.float64_flops_per_s);

  const auto expected =
      reference::tension_to_gauss({elements.rows, elements.columns, elements.h}, {n, n, dx}, to_host(Ta));
  const auto result = to_host(gauss);
  for (std::size_t k = 0; k < result.size(); ++k)
    if (!(std::abs(result[k] - expected[k]) <= 1e-10)) {
      fail(state,
           fmt::format("the tension at Gauss point {} is {} and should be {}", k, result[k], expected[k]));
      return;
    }
}

template <class Real>
void time_conservative(benchmark::State& state, const Suite& suite, int n) {
  const auto elements = square_elements(n);
  const auto x = deformed_nodes(elements);
  const auto nodes = to_nodes(x);
  const tissue::ConservativeMetric<Real, MemorySpace> metric(1, square_grid(n));
  const transfer::ConservativeTransfer<ExecutionSpace, Real> refresh(square_grid(n), elements,
                                                                     cells_per_element);
  const double size = static_cast<double>(n) * n;
  const double seconds =
      measure(state, batch_of(size), [&] { refresh.refresh(ExecutionSpace(), nodes, metric, 0); });
  report(state, suite, seconds, "nodes_per_s", size, conservative_refresh_traffic<Real>(),
         suite.float64_flops_per_s);

  plain::EdgeNetwork<double> expected(n);
  expected.refresh(cells_per_element, dx, x);
  const auto compare = [&](const char* name, const auto& view, const plain::Array<double>& values) {
    const auto result = to_host(view);
    for (std::size_t k = 0; k < result.size(); ++k)
      if (!(std::abs(result[k] - values[k]) <= 10 * tolerance<Real>)) {
        fail(state, fmt::format("entry {} of {} is {} and should be {}", k, name, result[k], values[k]));
        return;
      }
  };
  compare("diagonal", metric.diagonal, expected.rising);
  compare("inverse_mass", metric.inverse_mass, expected.inverse_mass);
}

template <class Real>
void time_expanded(benchmark::State& state, const Suite& suite, int n) {
  const auto elements = square_elements(n);
  const auto x = deformed_nodes(elements);
  const auto nodes = to_nodes(x);
  const tissue::ExpandedMetric<Real, MemorySpace> metric(1, square_grid(n));
  const transfer::ExpandedTransfer<ExecutionSpace, Real> refresh(square_grid(n), elements, cells_per_element);
  const double size = static_cast<double>(n) * n;
  const double seconds =
      measure(state, batch_of(size), [&] { refresh.refresh(ExecutionSpace(), nodes, metric, 0); });
  report(state, suite, seconds, "nodes_per_s", size, expanded_refresh_traffic<Real>(),
         suite.float64_flops_per_s);

  // Inside an element C^-1 is that of one F.
  const int middle = cells_per_element / 2;
  const auto F =
      reference::deformation_gradient({elements.rows, elements.columns, elements.h}, x, 0, 0, 0.5, 0.5);
  const double J = reference::determinant(F);
  const double g11 = (F[0][1] * F[0][1] + F[1][1] * F[1][1]) / (J * J);
  const double result = to_host(metric.g11)[static_cast<std::size_t>(middle) * n + middle];
  if (!(std::abs(result - g11) <= tolerance<Real>))
    fail(state, fmt::format("g11 in the first element is {} and should be {}", result, g11));
}

template <class Real>
void register_rows(const Suite& suite) {
  for (const int n : suite.sizes({121, 251, 511, 1021, 2041, 4091}, small_n)) {
    const auto row = [=](const char* name) {
      return fmt::format("transfer/{}/{}/{}", name, precision_name<Real>, n);
    };
    add_row(row("tension"), [=](benchmark::State& state) { time_tension<Real>(state, suite, n); });
    add_row(row("conservative"), [=](benchmark::State& state) { time_conservative<Real>(state, suite, n); });
    add_row(row("expanded"), [=](benchmark::State& state) { time_expanded<Real>(state, suite, n); });
  }
}

}  // namespace

void register_transfer(const Suite& suite) {
  register_rows<double>(suite);
  register_rows<float>(suite);
}

}  // namespace myowave::bench
