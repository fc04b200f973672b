// Electromechanics: its fields, the explicit steps, and what is saved of it. Included by its instantiations
// only.
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

#include "kernels/observe/probes.hpp"
#include "solver/base/host_copy.hpp"
#include "solver/coupling/electromechanics_common.hpp"

namespace myowave::solver {

namespace detail {

template <class ExecutionSpace, class View>
void upload(const ExecutionSpace& space, const View& view, const std::vector<double>& values) {
  using Real = typename View::non_const_value_type;
  auto host = Kokkos::create_mirror_view(Kokkos::WithoutInitializing, view);
  std::transform(values.begin(), values.end(), host.data(), [](double v) { return static_cast<Real>(v); });
  Kokkos::deep_copy(space, view, host);
  space.fence("myowave::solver::upload");
}

template <class ExecutionSpace, class View>
std::vector<double> to_host(const ExecutionSpace& space, const View& view) {
  const auto host = host_copy(space, view);
  return {host.data(), host.data() + host.size()};
}

// Whether steps can be taken on tiles; else one step at a time over the whole sheet.
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

}  // namespace detail

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
      form_(select_form<ExecutionSpace, Real>(metric_form(scene), grid_, detail::make_elements(scene),
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
  allocate_fields(state);
  place_probes();
  if (scene.mechanics) solve_rest_state();
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::allocate_fields(const InitialState& state) {
  detail::upload(space_, state_.V, state.V);
  detail::upload(space_, state_.r, state.r);
  if (has_tension(scene_)) {
    state_.Ta = View("myowave::solver::Ta", 1, grid_.rows, grid_.columns);
    detail::upload(space_, state_.Ta, state.Ta);
  }
  if (scene_.on_unstable == OnUnstable::substep) {
    kept_ = {View("myowave::solver::V_kept", 1, grid_.rows, grid_.columns),
             View("myowave::solver::r_kept", 1, grid_.rows, grid_.columns),
             {}};
    if (has_tension(scene_)) kept_.Ta = View("myowave::solver::Ta_kept", 1, grid_.rows, grid_.columns);
  }
  if (scene_.output.maps)
    activation_ = {
        typename decltype(activation_)::Marks("myowave::solver::activation_marks", 1, grid_.rows,
                                              grid_.columns),
        typename decltype(activation_)::Records("myowave::solver::activation", 1, grid_.rows, grid_.columns)};
  // Single steps update r and Ta in place.
  if (detail::steps_in_tiles(form_)) {
    spare_.r = View("myowave::solver::r_next", 1, grid_.rows, grid_.columns);
    if (has_tension(scene_)) spare_.Ta = View("myowave::solver::Ta_next", 1, grid_.rows, grid_.columns);
  }
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::place_probes() {
  std::vector<std::int64_t> nodes;
  for (const auto& [row, column] : scene_.output.probes) {
    nodes.push_back(static_cast<std::int64_t>(row) * grid_.columns + column);
    probe_rows_ |= std::uint64_t(1) << row % 64;
  }
  probe_nodes_ = Kokkos::View<std::int64_t*, Space>("myowave::solver::probe_nodes", nodes.size());
  Kokkos::deep_copy(space_, probe_nodes_,
                    Kokkos::View<const std::int64_t*, Kokkos::HostSpace>(nodes.data(), nodes.size()));
  space_.fence("myowave::solver::probe_nodes");
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::advance(std::int64_t first, std::int64_t steps, int substeps) {
  const std::int64_t count = steps * substeps;
  const auto probes = probe_nodes_.extent(0);
  if (probe_record_.device.extent(0) < static_cast<std::size_t>(count))
    probe_record_ = DeviceAndHost<Record>("myowave::solver::probe_record", count, probes);
  take_steps(first * substeps, count, scene_.time.dt / substeps);

  const detail::Timer timer(phases_->observe);
  const auto history = detail::first_rows(probe_record_.host, count);
  Kokkos::deep_copy(space_, history, detail::first_rows(probe_record_.device, count));
  space_.fence("myowave::solver::advance");
  probe_history_.resize(static_cast<std::size_t>(steps) * probes);
  for (std::int64_t n = 0; n < steps; ++n)
    for (std::size_t p = 0; p < probes; ++p) probe_history_[n * probes + p] = history(n * substeps, p);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::take_steps(std::int64_t first, std::int64_t count, double dt) {
  const detail::Timer timer(phases_->excitation);
  const auto stimuli_at = [&](std::int64_t n) -> const auto& {
    return schedule_.active(static_cast<double>(first + n) * dt);
  };
  for (std::int64_t n = 0; n < count;) {
    std::int64_t quiet = n;  // steps n <= i < quiet have no stimulus
    while (detail::steps_in_tiles(form_) && quiet < count && stimuli_at(quiet).empty()) ++quiet;
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
  detail::copy_fields(space_, kept_, state_);
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::go_back() {
  detail::copy_fields(space_, state_, kept_);
}

template <class ExecutionSpace, class Real>
InitialState Electromechanics<ExecutionSpace, Real>::download() const {
  return {grid_.rows, grid_.columns, detail::to_host(space_, state_.V), detail::to_host(space_, state_.r),
          has_tension(scene_) ? detail::to_host(space_, state_.Ta) : std::vector<double>(state_.V.size())};
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
  if (!node_history_.empty()) refresh_metric(t);
}

}  // namespace myowave::solver
