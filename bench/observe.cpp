// Samples that a run takes between its steps:
//   observe / tips | state_check | probes | activation / float64|float32 / n     observe / areas / elements
//   a side
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "kernels/observe/activation.hpp"
#include "kernels/observe/area_change.hpp"
#include "kernels/observe/phase_singularity.hpp"
#include "kernels/observe/probes.hpp"
#include "kernels/observe/state_check.hpp"
#include "tests/support/reference_excitation.hpp"

namespace myowave::bench {
namespace {

constexpr int small_n = 251;
constexpr int small_mesh = 12;
constexpr int largest_reference_n = 1024;

template <class Real>
struct Sheet {
  using View = EnsembleField<Real, MemorySpace>;
  View V, r, Ta;

  explicit Sheet(int n)
      : V("myowave::bench::V", 1, n, n), r("myowave::bench::r", 1, n, n), Ta("myowave::bench::Ta", 1, n, n) {
    fill(V, [](int i, int j) { return static_cast<Real>(initial_V(i, j)); });
    fill(r, [](int i, int j) { return static_cast<Real>(initial_r(i, j)); });
    fill(Ta, [](int i, int j) { return static_cast<Real>(initial_Ta(i, j)); });
  }
};

template <class Real>
void time_tips(benchmark::State& state, const Suite& suite, int n) {
  const Sheet<Real> sheet(n);
  using Diffusion = tissue::IdentityDiffusion<Real, MemorySpace>;
  const tissue::MonodomainRate<Diffusion, solver::Model<Real>> rate{
      Diffusion(square_grid(n)), solver::make_model<Real>({}, {}), sheet.V, sheet.r, {}};
  const Kokkos::View<int, MemorySpace> count("myowave::bench::tip_count");
  const Kokkos::View<observe::PhaseSingularity*, MemorySpace> found("myowave::bench::tip_list", n * n / 4);
  const double size = static_cast<double>(n) * n;
  const double seconds = measure(state, batch_of(size), [&] {
    Kokkos::deep_copy(ExecutionSpace(), count, 0);
    observe::find_phase_singularities(ExecutionSpace(), square_grid(n), sheet.V, rate, count, found);
  });
  report(state, suite, seconds, "nodes_per_s", size, tips_traffic<Real>(), suite.peak_flops_per_s<Real>());
  int tips = 0;
  Kokkos::deep_copy(tips, count);
  state.counters["tips"] = tips;
  if (n > largest_reference_n || sizeof(Real) != sizeof(double)) return;
  const reference::Grid grid{n, n, dx};
  const auto V = to_host(sheet.V), r = to_host(sheet.r);
  const auto rates = reference::voltage_rate({}, V, r, reference::diffusion_identity(grid, V),
                                             std::vector<double>(V.size()));
  const auto expected = reference::phase_singularities(grid, V, rates).size();
  if (static_cast<std::size_t>(tips) != expected)
    fail(state, fmt::format("{} tips found, expected {}", tips, expected));
}

template <class Real>
void time_state_check(benchmark::State& state, const Suite& suite, int n) {
  const Sheet<Real> sheet(n);
  const double size = static_cast<double>(n) * n;
  observe::InspectedState found;
  const double seconds = measure(state, batch_of(size), [&] {
    found = observe::inspect_state(ExecutionSpace(), sheet.V, sheet.r, sheet.Ta);
  });
  report(state, suite, seconds, "nodes_per_s", size, state_check_traffic<Real>(),
         suite.peak_flops_per_s<Real>());
  if (found.first_non_finite != -1)
    fail(state, fmt::format("node {} is reported as not finite", found.first_non_finite));
}

template <class Real>
void time_probes(benchmark::State& state, int n) {
  const Sheet<Real> sheet(n);
  constexpr int probes = 4;
  const Kokkos::View<std::int64_t*, MemorySpace> nodes("myowave::bench::probe_nodes", probes);
  const auto host = Kokkos::create_mirror_view(nodes);
  for (int p = 0; p < probes; ++p) host(p) = (p + 1) * (static_cast<std::int64_t>(n) * n / (probes + 1));
  Kokkos::deep_copy(nodes, host);
  const Kokkos::View<Real**, Kokkos::LayoutRight, MemorySpace> record("myowave::bench::record", 1, probes);
  const double seconds =
      measure(state, 1000, [&] { observe::record_probes(ExecutionSpace(), sheet.V, nodes, record, 0); });
  state.counters["probes_per_s"] =
      static_cast<double>(probes) * static_cast<double>(state.iterations()) / seconds;
  for (int p = 0; p < probes; ++p)
    if (to_host(record)[p] != static_cast<Real>(initial_V(host(p) / n, host(p) % n)))
      fail(state, "a probe recorded another node");
}

void time_areas(benchmark::State& state, const Suite& suite, int elements) {
  const auto grid = square_elements(cells_per_element * elements + 1);
  const auto x = deformed_nodes(grid);
  const auto nodes = to_nodes(x);
  const Kokkos::View<double*, MemorySpace> areas("myowave::bench::areas", grid.elements());
  const double seconds = measure(state, batch_of(10.0 * grid.elements()),
                                 [&] { observe::element_areas(ExecutionSpace(), grid, nodes, areas); });
  report(state, suite, seconds, "elements_per_s", grid.elements(), area_traffic, suite.float64_flops_per_s);
  const auto expected = reference::element_areas({grid.rows, grid.columns, grid.h}, x);
  const auto result = to_host(areas);
  for (std::size_t e = 0; e < result.size(); ++e)
    if (!(std::abs(result[e] - expected[e]) <= 1e-9 * expected[e])) {
      fail(state, fmt::format("the area of element {} is {} and should be {}", e, result[e], expected[e]));
      return;
    }
}

// Alternates between the sheet and the same sheet shifted by a row, so that records change as at a front.
template <class Real>
void time_activation(benchmark::State& state, const Suite& suite, int n) {
  const Sheet<Real> sheet(n), later(n);
  fill(later.V, [](int i, int j) { return static_cast<Real>(initial_V(i + 1, j)); });
  using Fields = observe::ActivationFields<MemorySpace>;
  const Fields fields{Fields::Marks("myowave::bench::marks", 1, n, n),
                      Fields::Records("myowave::bench::records", 1, n, n)};
  observe::begin_activation(ExecutionSpace(), sheet.V, fields);
  double t = 0;
  const double size = static_cast<double>(n) * n;
  const double seconds = measure(state, batch_of(size), [&] {
    const auto& V = std::fmod(t, 2) == 0 ? later.V : sheet.V;
    observe::sample_activation(ExecutionSpace(), V, observe::ActivationInterval{t, t + 1, 0, {}}, fields);
    t += 1;
  });
  report(state, suite, seconds, "nodes_per_s", size, activation_traffic<Real>(),
         suite.peak_flops_per_s<Real>());
  const auto last = to_host(fields.marks);
  if (!std::isfinite(last[0])) fail(state, "a mark is not finite");
}

template <class Real>
void register_rows(const Suite& suite) {
  for (const int n : suite.sizes({251, 1024, 4096}, small_n)) {
    const auto row = [=](const char* name) {
      return fmt::format("observe/{}/{}/{}", name, precision_name<Real>, n);
    };
    add_row(row("tips"), [=](benchmark::State& state) { time_tips<Real>(state, suite, n); });
    add_row(row("state_check"), [=](benchmark::State& state) { time_state_check<Real>(state, suite, n); });
    add_row(row("activation"), [=](benchmark::State& state) { time_activation<Real>(state, suite, n); });
    add_row(row("probes"), [=](benchmark::State& state) { time_probes<Real>(state, n); });
  }
}

}  // namespace

void register_observe(const Suite& suite) {
  register_rows<double>(suite);
  register_rows<float>(suite);
  for (const int elements : suite.sizes({12, 25, 50, 100, 250}, small_mesh))
    add_row(fmt::format("observe/areas/{}", elements),
            [=](benchmark::State& state) { time_areas(state, suite, elements); });
}

}  // namespace myowave::bench
