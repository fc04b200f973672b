#include "solver/electromechanics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "kernels/observe/area_change.hpp"
#include "kernels/observe/probes.hpp"
#include "kernels/transfer/tension_to_gauss.hpp"
#include "solver/error.hpp"
#include "solver/mirror.hpp"
#include "solver/rhythm.hpp"
#include "solver/state_check.hpp"

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

// Maps and probes tell beats alike.
constexpr observe::ActivationLevels beat_levels{static_cast<float>(BeatDetector::threshold),
                                                static_cast<float>(BeatDetector::rearm),
                                                static_cast<float>(BeatDetector::apd_level)};

elastic::ElementGrid make_elements(const Scene& scene) {
  if (!scene.mechanics) return {};
  const int cells = scene.mechanics->cells_per_element;
  return {(scene.grid.rows - 1) / cells, (scene.grid.columns - 1) / cells, cells * scene.grid.dx};
}

template <class ExecutionSpace, class View>
void upload(const ExecutionSpace& space, const View& view, const std::vector<double>& values) {
  using Real = typename View::non_const_value_type;
  auto host = Kokkos::create_mirror_view(Kokkos::WithoutInitializing, view);
  std::transform(values.begin(), values.end(), host.data(), [](double v) { return static_cast<Real>(v); });
  Kokkos::deep_copy(space, view, host);
  space.fence("myowave::solver::upload");
}

// What is in use of a View with room for more.
template <class DataType, class... Traits>
auto first_rows(const Kokkos::View<DataType, Traits...>& view, std::size_t rows) {
  const std::pair<std::size_t, std::size_t> range{0, rows};
  if constexpr (Kokkos::View<DataType, Traits...>::rank() == 1)
    return Kokkos::subview(view, range);
  else
    return Kokkos::subview(view, range, Kokkos::ALL);
}

template <class ExecutionSpace, class View>
std::vector<double> to_host(const ExecutionSpace& space, const View& view) {
  const auto host = mirror_of(space, view);
  return {host.data(), host.data() + host.size()};
}

// Whether steps can go on tile by tile; else one by one over the whole sheet.
bool steps_in_tiles(const auto& form) {
  return std::visit([](const auto& f) { return std::decay_t<decltype(f.diffusion)>::mirrored_edges; }, form);
}

template <class ExecutionSpace, class View>
void copy_fields(const ExecutionSpace& space, const tissue::ExcitationFields<View>& to,
                 const tissue::ExcitationFields<View>& from) {
  Kokkos::deep_copy(space, to.V, from.V);
  Kokkos::deep_copy(space, to.r, from.r);
  Kokkos::deep_copy(space, to.Ta, from.Ta);
}

auto values_of(const tissue::ActiveStimulus& stimulus) {
  const auto& r = stimulus.region;
  return std::tuple(r.row_begin, r.row_end, r.column_begin, r.column_end, r.center_row, r.center_column,
                    r.radius2, stimulus.amplitude);
}

}  // namespace

template <class ExecutionSpace, class Real>
Electromechanics<ExecutionSpace, Real>::Electromechanics(const ExecutionOn<ExecutionSpace>& execution,
                                                         const Scene& scene, const InitialState& state,
                                                         PhaseSeconds& phases,
                                                         MechanicsStatistics& statistics)
    : space_(execution.device),
      host_(execution.host),
      scene_(scene),
      phases_(&phases),
      statistics_(&statistics),
      grid_{scene.grid.rows, scene.grid.columns, scene.grid.dx},
      schedule_(scene.stimuli, scene.grid, scene.time.dt),
      model_(make_model<Real>(scene.excitation, scene.tension)),
      form_(select_form<ExecutionSpace, Real>(metric_form(scene), grid_, make_elements(scene),
                                              scene.mechanics ? scene.mechanics->cells_per_element : 1,
                                              scene.scheme)),
      state_{View("myowave::solver::V", 1, grid_.rows, grid_.columns),
             View("myowave::solver::r", 1, grid_.rows, grid_.columns),
             {}},
      spare_{View("myowave::solver::V_next", 1, grid_.rows, grid_.columns), {}, {}},
      clean_(clean_range(scene, state)),
      stable_dt_(largest_stable_dt(scene, undeformed_stiffness(scene))),
      probe_values_("myowave::solver::probe_values", 3, scene.output.probes.size()),
      tip_count_("myowave::solver::tip_count"),
      tip_list_("myowave::solver::tip_list", first_tips),
      stimuli_("myowave::solver::stimuli", scene.stimuli.size()) {
  upload(space_, state_.V, state.V);
  upload(space_, state_.r, state.r);
  if (has_tension(scene)) {
    state_.Ta = View("myowave::solver::Ta", 1, grid_.rows, grid_.columns);
    upload(space_, state_.Ta, state.Ta);
  }
  if (scene.on_unstable == OnUnstable::substep) {
    kept_ = {View("myowave::solver::V_kept", 1, grid_.rows, grid_.columns),
             View("myowave::solver::r_kept", 1, grid_.rows, grid_.columns),
             {}};
    if (has_tension(scene)) kept_.Ta = View("myowave::solver::Ta_kept", 1, grid_.rows, grid_.columns);
  }
  if (scene.output.maps)
    activation_ = {
        typename decltype(activation_)::Marks("myowave::solver::activation_marks", 1, grid_.rows,
                                              grid_.columns),
        typename decltype(activation_)::Records("myowave::solver::activation", 1, grid_.rows, grid_.columns)};
  // Single steps update r and Ta in place.
  if (steps_in_tiles(form_)) {
    spare_.r = View("myowave::solver::r_next", 1, grid_.rows, grid_.columns);
    if (has_tension(scene)) spare_.Ta = View("myowave::solver::Ta_next", 1, grid_.rows, grid_.columns);
  }

  std::vector<std::int64_t> nodes;
  for (const auto& [row, column] : scene.output.probes) {
    nodes.push_back(static_cast<std::int64_t>(row) * grid_.columns + column);
    probe_rows_ |= std::uint64_t(1) << row % 64;
  }
  probe_nodes_ = Kokkos::View<std::int64_t*, Space>("myowave::solver::probe_nodes", nodes.size());
  Kokkos::deep_copy(space_, probe_nodes_,
                    Kokkos::View<const std::int64_t*, Kokkos::HostSpace>(nodes.data(), nodes.size()));
  space_.fence("myowave::solver::probe_nodes");

  if (!scene.mechanics) return;
  const auto elements = make_elements(scene);
  gauss_tension_ = Mirrored<GaussTension<Space>>("myowave::solver::gauss_tension", elements.elements());
  solved_nodes_ = SolvedNodes(elements, solves_of_metric(scene));
  nodes_ = Mirrored<Nodes<Space>>("myowave::solver::nodes", elements.nodes());
  element_areas_ =
      Kokkos::View<double*, Kokkos::HostSpace>("myowave::solver::element_areas", elements.elements());
  const Timer timer(phases_->mechanics);
  equilibrium_.emplace(host_, elements, *scene.mechanics);
  const SolveReport rest = equilibrium_->solve(host_, gauss_tension_.host, 0);
  statistics_->min_J = std::min(statistics_->min_J, rest.min_J);
  observe::element_areas(host_, elements, equilibrium_->nodes(), element_areas_);
  host_.fence("myowave::solver::rest_state");
  rest_areas_.assign(element_areas_.data(), element_areas_.data() + element_areas_.size());
}

template <class ExecutionSpace, class Real>
int Electromechanics<ExecutionSpace, Real>::mechanics_interval() const {
  return equilibrium_ ? scene_.mechanics->interval : 0;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::solve_mechanics(double t) {
  download_tension();
  bool moved = false;
  {
    const Timer timer(phases_->mechanics);
    if (equilibrium_->is_solved_for(host_, gauss_tension_.host))
      ++statistics_->left_out;
    else
      add_to_statistics(equilibrium_->solve(host_, gauss_tension_.host, t));
    moved = solved_nodes_.add(t, equilibrium_->nodes());
  }
  if (place_nodes(t)) refresh_metric(t);
  if (moved) measure_area();
  area_.t = t;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::download_tension() {
  if (!contracts(scene_)) return;
  const Timer timer(phases_->transfer);
  transfer::tension_to_gauss<ExecutionSpace, Real>(
      space_, equilibrium_->grid(), scene_.mechanics->cells_per_element, state_.Ta, 0, gauss_tension_.device);
  Kokkos::deep_copy(space_, gauss_tension_.host, gauss_tension_.device);
  space_.fence("myowave::solver::download_tension");
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::add_to_statistics(const SolveReport& report) {
  ++statistics_->solves;
  statistics_->newton_iterations += report.iterations;
  statistics_->newton_max = std::max(statistics_->newton_max, report.iterations);
  statistics_->factorizations += report.factorizations;
  statistics_->shifts += report.shifts;
  statistics_->not_elliptic += report.not_elliptic > 0 ? 1 : 0;
  statistics_->min_J = std::min(statistics_->min_J, report.min_J);
}

// Before the first solve they are all zero, which no sheet's are.
template <class ExecutionSpace, class Real>
bool Electromechanics<ExecutionSpace, Real>::place_nodes(double t) {
  const Timer timer(phases_->transfer);
  const double middle = t + 0.5 * scene_.mechanics->interval * scene_.time.dt;
  const auto& placed = solved_nodes_.at(middle);
  if (std::equal(placed.data(), placed.data() + placed.size(), nodes_.host.data())) return false;
  Kokkos::deep_copy(host_, nodes_.host, placed);
  host_.fence("myowave::solver::place_nodes");
  return true;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::refresh_metric(double t) {
  const Timer timer(phases_->transfer);
  const auto bounds = std::visit(
      [&](const auto& form) -> transfer::DeformationBounds {
        if constexpr (requires { form.transfer; }) {
          Kokkos::deep_copy(space_, nodes_.device, nodes_.host);
          return form.transfer.refresh(space_, nodes_.device, form.diffusion.metric, 0);
        } else {
          return {};
        }
      },
      form_);
  stable_dt_ = largest_stable_dt(scene_, std::max(undeformed_stiffness(scene_), bounds.max_stiffness));
  if (scene_.on_unstable == OnUnstable::stop && scene_.time.dt > stable_dt_)
    throw NumericalFailure(fmt::format(
        "t = {:.6g} t.u.: dt = {} is past the stability bound {:.6g}: the sheet is so contracted that the "
        "largest tr C^-1 is {:.6g} (smallest J {:.6g}). Set time.dt to {:.3g} or less, or "
        "accuracy.on_unstable to "
        "\"substep\"",
        t, scene_.time.dt, stable_dt_, bounds.max_trace_inverse_C, bounds.min_J, 0.9 * stable_dt_));
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::measure_area() {
  const Timer timer(phases_->observe);
  observe::element_areas(host_, equilibrium_->grid(), solved_nodes_.last(), element_areas_);
  host_.fence("myowave::solver::measure_area");
  const std::span<const double> areas(element_areas_.data(), element_areas_.size());
  area_ = {0, 0, areas[0] / rest_areas_[0], areas[0] / rest_areas_[0], 0};
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
std::vector<double> Electromechanics<ExecutionSpace, Real>::element_area_ratios() const {
  std::vector<double> ratios(rest_areas_.size());
  for (std::size_t e = 0; e < ratios.size(); ++e) ratios[e] = element_areas_[e] / rest_areas_[e];
  return ratios;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::advance(std::int64_t first, std::int64_t steps, int substeps) {
  const std::int64_t count = steps * substeps;
  const auto probes = probe_nodes_.extent(0);
  if (probe_record_.device.extent(0) < static_cast<std::size_t>(count))
    probe_record_ = Mirrored<Record>("myowave::solver::probe_record", count, probes);
  take_steps(first * substeps, count, scene_.time.dt / substeps);

  const Timer timer(phases_->observe);
  const auto history = first_rows(probe_record_.host, count);
  Kokkos::deep_copy(space_, history, first_rows(probe_record_.device, count));
  space_.fence("myowave::solver::advance");
  probe_history_.resize(static_cast<std::size_t>(steps) * probes);
  for (std::int64_t n = 0; n < steps; ++n)
    for (std::size_t p = 0; p < probes; ++p) probe_history_[n * probes + p] = history(n * substeps, p);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::take_steps(std::int64_t first, std::int64_t count, double dt) {
  const Timer timer(phases_->excitation);
  const auto stimuli_at = [&](std::int64_t n) -> const auto& {
    return schedule_.active(static_cast<double>(first + n) * dt);
  };
  for (std::int64_t n = 0; n < count;) {
    std::int64_t quiet = n;  // up to here no stimulus comes in between
    while (steps_in_tiles(form_) && quiet < count && stimuli_at(quiet).empty()) ++quiet;
    if (quiet > n) {
      tiled_steps(static_cast<int>(n), static_cast<int>(quiet - n), dt);
      n = quiet;
    } else {
      single_step(static_cast<int>(n), stimuli_at(n), dt);
      ++n;
    }
  }
  space_.fence("myowave::solver::take_steps");
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::tiled_steps(int first, int count, double dt) {
  std::visit(
      [&](const auto& form) {
        using Form = std::decay_t<decltype(form)>;
        if constexpr (decltype(Form::diffusion)::mirrored_edges)
          with_model<typename Form::Scheme>(scene_, model_, [&](const auto& model) {
            const observe::ProbeRecorder<std::decay_t<decltype(model)>, Space> record{
                probe_nodes_, probe_record_.device, {model, Real(dt)}, grid_.columns, probe_rows_};
            tissue::tiled_steps(space_, form.diffusion, model, dt, count, state_, spare_, first, record);
          });
      },
      form_);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::single_step(int n,
                                                         const std::vector<tissue::ActiveStimulus>& stimuli,
                                                         double dt) {
  std::visit(
      [&](const auto& form) {
        with_model<typename std::decay_t<decltype(form)>::Scheme>(scene_, model_, [&](const auto& model) {
          observe::record_seen(space_, state_.V, state_.r, probe_nodes_, probe_record_.device, n,
                               observe::SeenV<std::decay_t<decltype(model)>>{model, Real(dt)});
          tissue::monodomain_step(space_, form.diffusion, model, dt, state_.V, state_.r, state_.Ta, spare_.V);
        });
      },
      form_);
  for (const auto& stimulus : stimuli)
    tissue::add_stimulus(space_, spare_.V, stimulus, dt / scene_.excitation.C_m);
  std::swap(state_.V, spare_.V);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::keep() {
  copy_fields(space_, kept_, state_);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::go_back() {
  copy_fields(space_, state_, kept_);
}

template <class ExecutionSpace, class Real>
std::optional<std::string> Electromechanics<ExecutionSpace, Real>::check_state(double t, double dt) {
  const Timer timer(phases_->observe);
  const auto growing_noise = [&] {
    upload_stimuli(schedule_.active(t));
    return std::visit(
        [&](const auto& form) {
          using Rate = tissue::MonodomainRate<std::decay_t<decltype(form.diffusion)>, Model<Real>>;
          const Rate rate{form.diffusion, model_, state_.V, state_.r,
                          first_rows(stimuli_, uploaded_stimuli_.size())};
          return observe::growing_noise(space_, state_.V, rate, dt, largest_clean_noise);
        },
        form_);
  };
  return solver::check_state(space_, WatchedState<View>{state_, t}, clean_.with_margin(scene_),
                             growing_noise);
}

template <class ExecutionSpace, class Real>
double Electromechanics<ExecutionSpace, Real>::largest_tension() const {
  const auto& Ta = gauss_tension_.host;
  return Ta.size() == 0 ? 0 : *std::max_element(Ta.data(), Ta.data() + Ta.size());
}

template <class ExecutionSpace, class Real>
auto Electromechanics<ExecutionSpace, Real>::find_tips(double t) -> Activity {
  const Timer timer(phases_->observe);
  upload_stimuli(schedule_.active(t));
  const auto look = [&] {
    Kokkos::deep_copy(space_, tip_count_.device, 0);
    const double largest_V = std::visit(
        [&](const auto& form) {
          using Rate = tissue::MonodomainRate<std::decay_t<decltype(form.diffusion)>, Model<Real>>;
          const Rate rate{form.diffusion, model_, state_.V, state_.r,
                          first_rows(stimuli_, uploaded_stimuli_.size())};
          return observe::find_phase_singularities(space_, grid_, state_.V, rate, tip_count_.device,
                                                   tip_list_.device);
        },
        form_);
    Kokkos::deep_copy(space_, tip_count_.host, tip_count_.device);
    space_.fence("myowave::solver::find_tips");
    return largest_V;
  };
  Activity activity;
  activity.largest_V = look();
  const auto found = static_cast<std::size_t>(tip_count_.host());
  if (found > tip_list_.device.extent(0)) {  // look again, with room for them
    tip_list_ =
        Mirrored<Kokkos::View<observe::PhaseSingularity*, Space>>("myowave::solver::tip_list", 2 * found);
    look();
  }
  const auto list = first_rows(tip_list_.host, found);
  Kokkos::deep_copy(space_, list, first_rows(tip_list_.device, found));
  space_.fence("myowave::solver::find_tips");
  std::vector<observe::PhaseSingularity> sorted(list.data(), list.data() + found);
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::pair{a.row, a.column} < std::pair{b.row, b.column};
  });
  for (const auto& tip : sorted) activity.tips.push_back({tip.x, tip.y, tip.charge});
  return activity;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::look_at_activation(double t) {
  const Timer timer(phases_->observe);
  if (activation_look_)
    observe::look_at_activation(
        space_, state_.V,
        observe::ActivationLook{*activation_look_, t, scene_.output.period_from, beat_levels}, activation_);
  else
    observe::begin_activation(space_, state_.V, activation_, beat_levels);
  space_.fence("myowave::solver::look_at_activation");
  activation_look_ = t;
}

template <class ExecutionSpace, class Real>
ActivationMaps Electromechanics<ExecutionSpace, Real>::activation_maps() const {
  const Timer timer(phases_->observe);
  const auto records = mirror_of(space_, activation_.records);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  ActivationMaps maps;
  maps.rows = grid_.rows;
  maps.columns = grid_.columns;
  maps.dx = grid_.dx;
  maps.apd_level = BeatDetector::apd_level;
  for (std::size_t n = 0; n < records.size(); ++n) {
    const observe::ActivationRecord& node = records.data()[n];
    const bool activated = node.beats > 0;
    maps.activation.push_back(activated ? node.last : none);
    maps.first_activation.push_back(activated ? node.first : none);
    maps.period.push_back(node.periods > 0 ? node.mean_period : none);
    maps.period_sd.push_back(node.periods > 1 ? std::sqrt(node.squared_deviations / (node.periods - 1))
                                              : none);
    maps.apd.push_back(node.apds > 0 ? node.total_apd / node.apds : none);
    maps.beats.push_back(node.beats);
  }
  maps.conduction_velocity = conduction_velocity(grid_.rows, grid_.columns, grid_.dx, maps.activation);
  return maps;
}

// A look often finds the same stimuli as the one before: none, or those of a long pulse.
template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::upload_stimuli(
    const std::vector<tissue::ActiveStimulus>& active) {
  if (std::ranges::equal(active, uploaded_stimuli_, {}, values_of, values_of)) return;
  uploaded_stimuli_ = active;
  if (active.empty()) return;
  Kokkos::deep_copy(space_, first_rows(stimuli_, active.size()),
                    Kokkos::View<const tissue::ActiveStimulus*, Kokkos::HostSpace>(uploaded_stimuli_.data(),
                                                                                   active.size()));
}

template <class ExecutionSpace, class Real>
std::vector<double> Electromechanics<ExecutionSpace, Real>::probe_values() const {
  observe::record_probes(space_, state_.V, probe_nodes_, probe_values_.device, 0);
  observe::record_probes(space_, state_.r, probe_nodes_, probe_values_.device, 1);
  if (has_tension(scene_))  // else the row stays 0
    observe::record_probes(space_, state_.Ta, probe_nodes_, probe_values_.device, 2);
  Kokkos::deep_copy(space_, probe_values_.host, probe_values_.device);
  space_.fence("myowave::solver::probe_values");
  std::vector<double> values;
  for (std::size_t p = 0; p < probe_nodes_.extent(0); ++p)
    for (int variable = 0; variable < 3; ++variable) values.push_back(probe_values_.host(variable, p));
  return values;
}

template <class ExecutionSpace, class Real>
InitialState Electromechanics<ExecutionSpace, Real>::download() const {
  return {grid_.rows, grid_.columns, to_host(space_, state_.V), to_host(space_, state_.r),
          has_tension(scene_) ? to_host(space_, state_.Ta) : std::vector<double>(state_.V.size())};
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::save(StateWriter& writer) {
  space_.fence("myowave::solver::save");
  state(writer);
  if (equilibrium_) equilibrium_->save(writer);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::load(StateReader& reader, double t) {
  state(reader);
  if (!equilibrium_) return;
  equilibrium_->load(host_, reader);
  if (!solved_nodes_.empty()) refresh_metric(t);
}

template <class ExecutionSpace, class Real>
std::vector<double> Electromechanics<ExecutionSpace, Real>::download_nodes() const {
  const auto& nodes = solved_nodes_.last();
  return {nodes.data(), nodes.data() + nodes.size()};
}

template class Electromechanics<Kokkos::DefaultExecutionSpace, double>;
template class Electromechanics<Kokkos::DefaultExecutionSpace, float>;
#ifdef MYOWAVE_HAS_DEVICE
template class Electromechanics<Kokkos::DefaultHostExecutionSpace, double>;
template class Electromechanics<Kokkos::DefaultHostExecutionSpace, float>;
#endif
#ifdef MYOWAVE_HAS_SERIAL_TOO
template class Electromechanics<Kokkos::Serial, double>;
template class Electromechanics<Kokkos::Serial, float>;
#endif

}  // namespace myowave::solver
