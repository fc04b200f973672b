// The excitation step and its yardstick:
//   step|plain|plain_serial / identity|conservative_loaded|expanded / float64|float32 / n [/members:M]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/plain/step.hpp"
#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "kernels/tissue/tiled_step.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "tests/support/reference_excitation.hpp"

namespace myowave::bench {
namespace {

enum class Form { identity, conservative_loaded, expanded, identity_split, conservative_split };

template <Form form>
inline constexpr bool is_split = form == Form::identity_split || form == Form::conservative_split;
template <Form form>
using SchemeOf = std::conditional_t<is_split<form>, tissue::SplitStep, tissue::ForwardEuler>;
template <Form form, class Real>
using ModelOf = solver::Model<Real, SchemeOf<form>>;

constexpr const char* name_of(Form form) {
  return form == Form::identity             ? "identity"
         : form == Form::expanded           ? "expanded"
         : form == Form::identity_split     ? "identity_split"
         : form == Form::conservative_split ? "conservative_split"
                                            : "conservative_loaded";
}

template <class Real>
constexpr Traffic traffic_of(Form form) {
  return form == Form::identity   ? step_traffic<Real>(0, identity_flops)
         : form == Form::expanded ? step_traffic<Real>(5, expanded_flops)
                                  : step_traffic<Real>(4, conservative_flops);
}

template <class Real>
constexpr Traffic tiled_traffic_of(Form form, double depth) {
  return form == Form::identity             ? tiled_traffic<Real>(0, identity_flops, depth)
         : form == Form::identity_split     ? tiled_traffic<Real>(0, identity_split_flops, depth)
         : form == Form::conservative_split ? tiled_traffic<Real>(5, conservative_split_flops, depth)
                                            : tiled_traffic<Real>(4, conservative_flops, depth);
}

template <class Real>
constexpr Traffic plain_traffic_of(Form form) {
  return form == Form::identity ? plain_traffic<Real>(0, identity_flops)
                                : plain_traffic<Real>(5, conservative_flops);
}

using Values = std::vector<double>;

// V, r and Ta of one member, row-major.
using HostState = reference::ExcitationState;

// A metric that the deformed sheet gives to all members.
template <template <class, class> class Diffusion, template <class, class> class Metric,
          template <class, class> class Transfer, class Real>
Diffusion<Real, MemorySpace> deformed(int n, int members) {
  const auto grid = square_grid(n);
  const auto elements = square_elements(n);
  const auto nodes = to_nodes(deformed_nodes(elements));
  const Metric<Real, MemorySpace> metric(members, grid);
  const Transfer<ExecutionSpace, Real> transfer(grid, elements, cells_per_element);
  for (int m = 0; m < members; ++m) transfer.refresh(ExecutionSpace(), nodes, metric, m);
  return {grid, metric};
}

// The default stencil's, and those of nine points, with the parameters that `deformed` asks for.
template <class Real, class Space>
using FivePointDiffusion = tissue::ConservativeDiffusion<Real, Space>;
template <class Real, class Space>
using FivePointMetric = tissue::ConservativeMetric<Real, Space>;
template <class Space, class Real>
using FivePointTransfer = transfer::ConservativeTransfer<Space, Real>;
template <class Real, class Space>
using NinePointDiffusion = tissue::ConservativeDiffusion<Real, Space, tissue::Stencil::nine_point>;
template <class Real, class Space>
using NinePointMetric = tissue::ConservativeMetric<Real, Space, tissue::Stencil::nine_point>;
template <class Space, class Real>
using NinePointTransfer = transfer::ConservativeTransfer<Space, Real, tissue::Stencil::nine_point>;

template <Form form, class Real>
auto make_diffusion(int n, int members) {
  if constexpr (form == Form::identity)
    return tissue::IdentityDiffusion<Real, MemorySpace>(square_grid(n));
  else if constexpr (form == Form::identity_split)
    return tissue::IdentityDiffusion<Real, MemorySpace, tissue::Stencil::nine_point>(square_grid(n));
  else if constexpr (form == Form::conservative_split)
    return deformed<NinePointDiffusion, NinePointMetric, NinePointTransfer, Real>(n, members);
  else if constexpr (form == Form::expanded)
    return deformed<tissue::ExpandedDiffusion, tissue::ExpandedMetric, transfer::ExpandedTransfer, Real>(
        n, members);
  else
    return deformed<FivePointDiffusion, FivePointMetric, FivePointTransfer, Real>(n, members);
}

// The product's step.
template <Form form, class Real>
class Step {
 public:
  using View = EnsembleField<Real, MemorySpace>;

  Step(int n, int members)
      : diffusion_(make_diffusion<form, Real>(n, members)),
        model_(solver::in_scheme<SchemeOf<form>>(solver::make_model<Real>({}, {}))),
        V_("myowave::bench::V", members, n, n),
        V_next_("myowave::bench::V_next", members, n, n),
        r_("myowave::bench::r", members, n, n),
        Ta_("myowave::bench::Ta", members, n, n) {
    fill(V_, [](int i, int j) { return static_cast<Real>(initial_V(i, j)); });
    fill(r_, [](int i, int j) { return static_cast<Real>(initial_r(i, j)); });
    fill(Ta_, [](int i, int j) { return static_cast<Real>(initial_Ta(i, j)); });
  }

  void operator()() {
    tissue::monodomain_step(ExecutionSpace(), diffusion_, model_, dt, V_, r_, Ta_, V_next_);
    std::swap(V_, V_next_);
  }

  // Of the last member.
  HostState state() const {
    Kokkos::fence("myowave::bench::state");
    const auto last = [](const View& view) {
      return to_host(Kokkos::subview(view, static_cast<int>(view.extent(0)) - 1, Kokkos::ALL, Kokkos::ALL));
    };
    return {last(V_), last(r_), last(Ta_)};
  }

 private:
  decltype(make_diffusion<form, Real>(2, 1)) diffusion_;
  ModelOf<form, Real> model_;
  View V_, V_next_, r_, Ta_;
};

constexpr int steps_between_solves = 80;

// The product's steps, several a launch.
template <Form form, class Real>
class TiledSteps {
 public:
  using View = EnsembleField<Real, MemorySpace>;

  TiledSteps(int n, int members)
      : diffusion_(make_diffusion<form, Real>(n, members)),
        model_(solver::in_scheme<SchemeOf<form>>(solver::make_model<Real>({}, {}))) {
    for (auto* state : {&old_, &next_})
      *state = {View("myowave::bench::V", members, n, n), View("myowave::bench::r", members, n, n),
                View("myowave::bench::Ta", members, n, n)};
    fill(old_.V, [](int i, int j) { return static_cast<Real>(initial_V(i, j)); });
    fill(old_.r, [](int i, int j) { return static_cast<Real>(initial_r(i, j)); });
    fill(old_.Ta, [](int i, int j) { return static_cast<Real>(initial_Ta(i, j)); });
  }

  // Mean number of steps of a launch.
  double depth() const {
    using Tiled =
        tissue::TiledStep<ExecutionSpace, decltype(diffusion_), ModelOf<form, Real>, tissue::NoRecorder>;
    const int members = static_cast<int>(old_.V.extent(0));
    return double(steps_between_solves) /
           Tiled::Tiles::choose_passes(ExecutionSpace(), diffusion_.grid, members, steps_between_solves);
  }

  void operator()(int steps) {
    tissue::tiled_steps(ExecutionSpace(), diffusion_, model_, dt, steps, old_, next_);
  }

  // Of the last member.
  HostState state() const {
    Kokkos::fence("myowave::bench::state");
    const auto last = [](const View& view) {
      return to_host(Kokkos::subview(view, static_cast<int>(view.extent(0)) - 1, Kokkos::ALL, Kokkos::ALL));
    };
    return {last(old_.V), last(old_.r), last(old_.Ta)};
  }

 private:
  decltype(make_diffusion<form, Real>(2, 1)) diffusion_;
  ModelOf<form, Real> model_;
  tissue::ExcitationFields<View> old_, next_;
};

// The yardstick.
template <Form form, class Real>
class PlainStep {
 public:
  PlainStep(int n, plain::Threads threads) : n_(n), threads_(threads), old_(n), next_(n) {
    if constexpr (form != Form::identity) {
      network_ = plain::EdgeNetwork<Real>(n);
      network_.refresh(cells_per_element, dx, deformed_nodes(square_elements(n)));
    }
    const auto place = [n](const plain::Array<Real>& field, const auto& value) {
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          field[static_cast<std::size_t>(i) * n + j] = static_cast<Real>(value(i, j));
    };
    place(old_.V, initial_V);
    place(old_.r, initial_r);
    place(old_.Ta, initial_Ta);
  }

  void load(const HostState& state) {
    std::copy(state.V.begin(), state.V.end(), old_.V.data());
    std::copy(state.r.begin(), state.r.end(), old_.r.data());
    std::copy(state.Ta.begin(), state.Ta.end(), old_.Ta.data());
  }

  void operator()() {
    if constexpr (form == Form::identity)
      plain::step_identity(threads_, constants_, n_, old_, next_);
    else
      plain::step_conservative(threads_, constants_, network_, old_, next_);
    std::swap(old_, next_);
  }

  HostState state() const {
    const auto values = [](const plain::Array<Real>& field) {
      return Values(field.data(), field.data() + field.size());
    };
    return {values(old_.V), values(old_.r), values(old_.Ta)};
  }

 private:
  int n_;
  plain::Threads threads_;
  plain::Constants<Real> constants_;
  plain::EdgeNetwork<Real> network_;
  plain::Fields<Real> old_, next_;
};

constexpr int checked_steps = 4;
constexpr int checked_tiled_steps = 20;

// The tests' reference is slow; larger sheets are compared with the yardstick only.
constexpr int largest_reference_n = 251;

HostState reference_steps(Form form, int n, HostState state) {
  const reference::Grid grid{n, n, dx};
  const auto elements = square_elements(n);
  const reference::Mesh mesh{elements.rows, elements.columns, elements.h};
  const Values x = form == Form::identity ? Values{} : deformed_nodes(elements);
  const Values no_stimulus(grid.size());
  for (int step = 0; step < checked_steps; ++step) {
    const Values diffusion = form == Form::identity ? reference::diffusion_identity(grid, state.V)
                             : form == Form::expanded
                                 ? reference::diffusion_expanded(grid, mesh, x, state.V)
                                 : reference::diffusion_conservative(grid, mesh, x, state.V);
    state = reference::euler_step({}, {}, dt, state, diffusion, no_stimulus);
  }
  return state;
}

// Empty if both agree; V and r are of order one, Ta of order k_Ta.
std::string difference(const HostState& result, const HostState& expected, double tolerance) {
  const auto compare = [&](const char* field, const Values& a, const Values& b, double unit) -> std::string {
    for (std::size_t k = 0; k < a.size(); ++k)
      if (!(std::abs(a[k] - b[k]) <= tolerance * unit))
        return fmt::format("{} at node {} is {} and should be {}", field, k, a[k], b[k]);
    return {};
  };
  for (const std::string& found :
       {compare("V", result.V, expected.V, 1), compare("r", result.r, expected.r, 1),
        compare("Ta", result.Ta, expected.Ta, solver::TensionSettings{}.k_Ta)})
    if (!found.empty()) return found;
  return {};
}

// Continues the steps after the timing, and compares them with the references.
template <Form form, class Real, class Stepper>
std::string check(Stepper& stepper, int n, bool against_yardstick) {
  constexpr double tolerance = sizeof(Real) == sizeof(double) ? 1e-12 : 2e-5;
  const HostState start = stepper.state();
  for (int step = 0; step < checked_steps; ++step) stepper();
  const HostState result = stepper.state();
  std::string found;
  if constexpr (form != Form::expanded) {
    if (against_yardstick) {
      PlainStep<form, Real> yardstick(n, plain::Threads::all);
      yardstick.load(start);
      for (int step = 0; step < checked_steps; ++step) yardstick();
      found = difference(result, yardstick.state(), tolerance);
    }
  }
  if (found.empty() && n <= largest_reference_n)
    found = difference(result, reference_steps(form, n, start), tolerance);
  return found;
}

template <class Real>
void report_steps(benchmark::State& state, const Suite& suite, double seconds, double nodes,
                  const Traffic& node) {
  report(state, suite, seconds, "cell_steps_per_s", nodes, node, suite.peak_flops_per_s<Real>());
}

template <Form form, class Real>
void time_step(benchmark::State& state, const Suite& suite, int n, int members) {
  Step<form, Real> step(n, members);
  const double nodes = static_cast<double>(n) * n * members;
  const double seconds = measure(state, batch_of(nodes), [&] { step(); });
  report_steps<Real>(state, suite, seconds, nodes, traffic_of<Real>(form));
  const std::string wrong = check<form, Real>(step, n, true);
  if (!wrong.empty()) fail(state, wrong);
}

template <Form form, class Real>
void time_tiled(benchmark::State& state, const Suite& suite, int n, int members) {
  TiledSteps<form, Real> steps(n, members);
  const double nodes = static_cast<double>(n) * n * members * steps_between_solves;
  const double seconds = measure(state, batch_of(nodes), [&] { steps(steps_between_solves); });
  report_steps<Real>(state, suite, seconds, nodes, tiled_traffic_of<Real>(form, steps.depth()));

  // The same bits as single steps.
  TiledSteps<form, Real> tiled(n, members);
  Step<form, Real> single(n, members);
  tiled(checked_tiled_steps);
  for (int step = 0; step < checked_tiled_steps; ++step) single();
  const std::string wrong = difference(tiled.state(), single.state(), 0);
  if (!wrong.empty()) fail(state, wrong);
}

template <Form form, class Real>
void time_plain(benchmark::State& state, const Suite& suite, int n, plain::Threads threads) {
  PlainStep<form, Real> step(n, threads);
  const double nodes = static_cast<double>(n) * n;
  const double seconds = measure(state, batch_of(nodes), [&] { step(); });
  report_steps<Real>(state, suite, seconds, nodes, plain_traffic_of<Real>(form));
  const std::string wrong = check<form, Real>(step, n, threads == plain::Threads::one);
  if (!wrong.empty()) fail(state, wrong);
}

constexpr int small_n = 121;

template <Form form, class Real>
void register_rows(const Suite& suite) {
  const auto row = [](const char* kind, int n) {
    return fmt::format("{}/{}/{}/{}", kind, name_of(form), precision_name<Real>, n);
  };
  constexpr bool has_yardstick = form == Form::identity || form == Form::conservative_loaded;
  constexpr bool single = !is_split<form>, tiled = form != Form::expanded;
  const auto sizes = form == Form::identity ? suite.sizes({121, 251, 512, 1024, 2048, 4096}, small_n)
                                            : suite.sizes({121, 251, 511, 1021, 2041, 4091}, small_n);
  for (const int n : sizes) {
    if constexpr (has_yardstick)
      for (const auto threads : {plain::Threads::all, plain::Threads::one})
        add_row(row(threads == plain::Threads::one ? "plain_serial" : "plain", n),
                [=](benchmark::State& state) { time_plain<form, Real>(state, suite, n, threads); });
    if constexpr (single)
      add_row(row("step", n), [=](benchmark::State& state) { time_step<form, Real>(state, suite, n, 1); });
    if constexpr (tiled)
      add_row(row("tiled", n), [=](benchmark::State& state) { time_tiled<form, Real>(state, suite, n, 1); });
  }
  if constexpr (has_yardstick)
    for (const int n : suite.sizes({121, 251}, small_n))
      for (const int members : suite.sizes({1, 8, 64}, 8)) {
        add_row(fmt::format("{}/members:{}", row("step", n), members),
                [=](benchmark::State& state) { time_step<form, Real>(state, suite, n, members); });
        add_row(fmt::format("{}/members:{}", row("tiled", n), members),
                [=](benchmark::State& state) { time_tiled<form, Real>(state, suite, n, members); });
      }
}

template <class Real>
void register_forms(const Suite& suite) {
  register_rows<Form::identity, Real>(suite);
  register_rows<Form::conservative_loaded, Real>(suite);
  register_rows<Form::expanded, Real>(suite);
  register_rows<Form::identity_split, Real>(suite);
  register_rows<Form::conservative_split, Real>(suite);
}

}  // namespace

void register_tissue(const Suite& suite) {
  register_forms<double>(suite);
  register_forms<float>(suite);
}

}  // namespace myowave::bench
