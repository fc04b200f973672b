#include "solver/electromechanics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "kernels/observe/area_change.hpp"
#include "kernels/observe/finite_check.hpp"
#include "kernels/observe/probes.hpp"
#include "kernels/transfer/tension_to_gauss.hpp"
#include "solver/error.hpp"

namespace myowave::solver {
namespace {

using Clock = std::chrono::steady_clock;

// Adds the time of its scope to a phase.
class Timer {
 public:
  explicit Timer(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~Timer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  double& seconds_;
  Clock::time_point start_;
};

elastic::ElementGrid make_elements(const Scene& scene) {
  if (!scene.mechanics) return {};
  const int cells = scene.mechanics->cells_per_element;
  return {(scene.grid.rows - 1) / cells, (scene.grid.columns - 1) / cells, cells * scene.grid.dx};
}

// Room for singularities: turbulence has tens, raw step data hundreds; more than one in four squares
// is noise and only counted.
std::size_t tip_capacity(const GridSettings& grid) {
  return std::max<std::size_t>(256, static_cast<std::size_t>(grid.rows) * grid.columns / 4);
}

template <class View>
void upload(const View& view, const std::vector<double>& values) {
  using Real = typename View::non_const_value_type;
  auto host = Kokkos::create_mirror_view(Kokkos::WithoutInitializing, view);
  std::transform(values.begin(), values.end(), host.data(), [](double v) { return static_cast<Real>(v); });
  Kokkos::deep_copy(view, host);
}

template <class View>
std::vector<double> to_host(const View& view) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
  return {host.data(), host.data() + host.size()};
}

}  // namespace

double largest_stable_dt(const Scene& scene, double trace_inverse_C) {
  const auto& e = scene.excitation;
  const double diffusion = 4 * e.D * trace_inverse_C / (scene.grid.dx * scene.grid.dx);
  const double reaction = e.k * std::abs(1 - e.a);
  return 2 * e.C_m / (diffusion + reaction);
}

template <class ExecutionSpace, class Real>
Electromechanics<ExecutionSpace, Real>::Electromechanics(const ExecutionSpace& space, const Scene& scene,
                                                         const InitialState& state, PhaseSeconds& phases,
                                                         MechanicsStatistics& statistics)
    : space_(space),
      scene_(scene),
      phases_(&phases),
      statistics_(&statistics),
      grid_{scene.grid.rows, scene.grid.columns, scene.grid.dx},
      schedule_(scene.stimuli, scene.grid, scene.time.dt),
      model_(make_model<Real>(scene.excitation, scene.tension)),
      form_(select_form<ExecutionSpace, Real>(scene.mechanics ? scene.metric : MetricForm::none, grid_,
                                              make_elements(scene),
                                              scene.mechanics ? scene.mechanics->cells_per_element : 1)),
      V_("myowave::solver::V", 1, grid_.rows, grid_.columns),
      V_next_("myowave::solver::V_next", 1, grid_.rows, grid_.columns),
      r_("myowave::solver::r", 1, grid_.rows, grid_.columns),
      Ta_("myowave::solver::Ta", 1, grid_.rows, grid_.columns),
      tip_count_("myowave::solver::tip_count"),
      tip_list_("myowave::solver::tip_list", tip_capacity(scene.grid)) {
  upload(V_, state.V);
  upload(r_, state.r);
  upload(Ta_, state.Ta);

  std::vector<std::int64_t> nodes;
  for (const auto& [row, column] : scene.output.probes)
    nodes.push_back(static_cast<std::int64_t>(row) * grid_.columns + column);
  probe_nodes_ = Kokkos::View<std::int64_t*, Space>("myowave::solver::probe_nodes", nodes.size());
  Kokkos::deep_copy(probe_nodes_,
                    Kokkos::View<const std::int64_t*, Kokkos::HostSpace>(nodes.data(), nodes.size()));

  if (!scene.mechanics) return;
  const auto elements = make_elements(scene);
  gauss_tension_ = GaussTension<Space>("myowave::solver::gauss_tension", elements.elements());
  element_areas_ = Kokkos::View<double*, Space>("myowave::solver::element_areas", elements.elements());
  const Timer timer(phases_->mechanics);
  equilibrium_.emplace(space_, elements, *scene.mechanics);
  equilibrium_->solve(space_, gauss_tension_, 0);
  observe::element_areas(space_, elements, equilibrium_->nodes(), element_areas_);
  rest_areas_ = to_host(element_areas_);
}

template <class ExecutionSpace, class Real>
int Electromechanics<ExecutionSpace, Real>::mechanics_interval() const {
  return equilibrium_ ? scene_.mechanics->interval : 0;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::solve_mechanics(double t) {
  {
    const Timer timer(phases_->transfer);
    if (scene_.mechanics->contraction)
      transfer::tension_to_gauss<ExecutionSpace, Real>(
          space_, equilibrium_->grid(), scene_.mechanics->cells_per_element, Ta_, 0, gauss_tension_);
    space_.fence("myowave::solver::solve_mechanics");
  }
  {
    const Timer timer(phases_->mechanics);
    const SolveReport report = equilibrium_->solve(space_, gauss_tension_, t);
    ++statistics_->solves;
    statistics_->newton_iterations += report.iterations;
    statistics_->newton_max = std::max(statistics_->newton_max, report.iterations);
    statistics_->factorizations += report.factorizations;
    statistics_->shifts += report.shifts;
    statistics_->min_J = std::min(statistics_->min_J, report.min_J);
  }
  refresh_metric(t);
  measure_area(t);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::refresh_metric(double t) {
  const Timer timer(phases_->transfer);
  const auto bounds = std::visit(
      [&](const auto& form) -> transfer::DeformationBounds {
        if constexpr (requires { form.transfer; })
          return form.transfer.refresh(space_, equilibrium_->nodes(), form.diffusion.metric, 0);
        else
          return {};
      },
      form_);
  const double bound = largest_stable_dt(scene_, std::max(2.0, bounds.max_trace_inverse_C));
  if (scene_.time.dt > bound)
    throw NumericalFailure(fmt::format(
        "t = {:.6g} t.u.: dt = {} is past the stability bound {:.6g}: the sheet is so contracted that the "
        "largest tr C^-1 is {:.6g} (smallest J {:.6g}). Set time.dt to {:.3g} or less",
        t, scene_.time.dt, bound, bounds.max_trace_inverse_C, bounds.min_J, 0.9 * bound));
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::measure_area(double t) {
  const Timer timer(phases_->observe);
  observe::element_areas(space_, equilibrium_->grid(), equilibrium_->nodes(), element_areas_);
  const std::vector<double> areas = to_host(element_areas_);
  area_ = {t, 0, areas[0] / rest_areas_[0], areas[0] / rest_areas_[0], 0};
  for (std::size_t e = 0; e < areas.size(); ++e) {
    area_.min_ratio = std::min(area_.min_ratio, areas[e] / rest_areas_[e]);
    area_.max_ratio = std::max(area_.max_ratio, areas[e] / rest_areas_[e]);
  }
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  const auto elements = equilibrium_->grid();
  area_.ratio = total / std::accumulate(rest_areas_.begin(), rest_areas_.end(), 0.0);
  area_.shortening = 1 - std::sqrt(total / (elements.elements() * elements.h * elements.h));
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::advance(std::int64_t first, std::int64_t count) {
  const Timer timer(phases_->excitation);
  const double dt = scene_.time.dt;
  const auto probes = probe_nodes_.extent(0);
  if (probe_record_.extent(0) < static_cast<std::size_t>(count))
    Kokkos::realloc(Kokkos::WithoutInitializing, probe_record_, count, probes);
  for (std::int64_t n = 0; n < count; ++n) {
    const double t = static_cast<double>(first + n) * dt;
    observe::record_probes(space_, V_, probe_nodes_, probe_record_, static_cast<int>(n));
    std::visit(
        [&](const auto& form) {
          tissue::monodomain_step(space_, form.diffusion, model_, dt, V_, r_, Ta_, V_next_);
        },
        form_);
    for (const auto& stimulus : schedule_.active(t))
      tissue::add_stimulus(space_, V_next_, stimulus, dt / scene_.excitation.C_m);
    std::swap(V_, V_next_);
  }
  space_.fence("myowave::solver::advance");
  const auto history = Kokkos::create_mirror_view_and_copy(
      Kokkos::HostSpace{},
      Kokkos::subview(probe_record_, std::pair<std::int64_t, std::int64_t>{0, count}, Kokkos::ALL));
  probe_history_.resize(static_cast<std::size_t>(count) * probes);
  for (std::int64_t n = 0; n < count; ++n)
    for (std::size_t p = 0; p < probes; ++p) probe_history_[n * probes + p] = history(n, p);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::check_finite(double t) const {
  const Timer timer(phases_->observe);
  const long node = observe::first_non_finite(space_, V_, r_, Ta_);
  if (node < 0) return;
  const int row = static_cast<int>(node / grid_.columns), column = static_cast<int>(node % grid_.columns);
  const auto value = [&](const View& view) {
    Real host;
    Kokkos::deep_copy(host, Kokkos::subview(view, 0, row, column));
    return static_cast<double>(host);
  };
  throw NumericalFailure(fmt::format(
      "t = {:.6g} t.u.: the excitation is not finite at node (row {}, column {}): V = {}, r = {}, Ta = {}. "
      "Use a smaller time.dt, or look at the stimulus amplitude and at excitation.k and mu2",
      t, row, column, value(V_), value(r_), value(Ta_)));
}

template <class ExecutionSpace, class Real>
auto Electromechanics<ExecutionSpace, Real>::find_tips(double t) -> Activity {
  const Timer timer(phases_->observe);
  const auto& active = schedule_.active(t);
  if (active_stimuli_.extent(0) != active.size())
    active_stimuli_ =
        Kokkos::View<tissue::ActiveStimulus*, Space>("myowave::solver::active_stimuli", active.size());
  if (!active.empty())
    Kokkos::deep_copy(active_stimuli_, Kokkos::View<const tissue::ActiveStimulus*, Kokkos::HostSpace>(
                                           active.data(), active.size()));
  Kokkos::deep_copy(space_, tip_count_, 0);
  Activity activity;
  activity.largest_V = std::visit(
      [&](const auto& form) {
        using Rate = tissue::MonodomainRate<std::decay_t<decltype(form.diffusion)>, Model<Real>>;
        const Rate rate{form.diffusion, model_, V_, r_, active_stimuli_};
        return observe::find_phase_singularities(space_, grid_, V_, rate, tip_count_, tip_list_);
      },
      form_);
  int count = 0;
  Kokkos::deep_copy(count, tip_count_);
  const auto found = static_cast<std::size_t>(std::min<std::int64_t>(count, tip_list_.extent(0)));
  const auto list = Kokkos::create_mirror_view_and_copy(
      Kokkos::HostSpace{}, Kokkos::subview(tip_list_, std::pair<std::size_t, std::size_t>{0, found}));
  std::vector<observe::PhaseSingularity> sorted(list.data(), list.data() + found);
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::pair{a.row, a.column} < std::pair{b.row, b.column};
  });
  for (const auto& tip : sorted) activity.tips.push_back({tip.x, tip.y, tip.charge});
  return activity;
}

template <class ExecutionSpace, class Real>
std::vector<double> Electromechanics<ExecutionSpace, Real>::probe_values() const {
  const auto probes = probe_nodes_.extent(0);
  const Kokkos::View<Real**, Kokkos::LayoutRight, Space> record("myowave::solver::probe_values", 3, probes);
  observe::record_probes(space_, V_, probe_nodes_, record, 0);
  observe::record_probes(space_, r_, probe_nodes_, record, 1);
  observe::record_probes(space_, Ta_, probe_nodes_, record, 2);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, record);
  std::vector<double> values;
  for (std::size_t p = 0; p < probes; ++p)
    for (int variable = 0; variable < 3; ++variable) values.push_back(host(variable, p));
  return values;
}

template <class ExecutionSpace, class Real>
InitialState Electromechanics<ExecutionSpace, Real>::download() const {
  return {grid_.rows, grid_.columns, to_host(V_), to_host(r_), to_host(Ta_)};
}

template <class ExecutionSpace, class Real>
std::vector<double> Electromechanics<ExecutionSpace, Real>::download_nodes() const {
  return equilibrium_ ? to_host(equilibrium_->nodes()) : std::vector<double>{};
}

template class Electromechanics<Kokkos::DefaultExecutionSpace, double>;
template class Electromechanics<Kokkos::DefaultExecutionSpace, float>;

}  // namespace myowave::solver
