// Electromechanics: solves of the mechanics and the metric that they give. Included by its instantiations
// only.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

#include "kernels/observe/area_change.hpp"
#include "kernels/transfer/tension_to_gauss.hpp"
#include "solver/base/error.hpp"
#include "solver/coupling/electromechanics_common.hpp"

namespace myowave::solver {

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::solve_rest_state() {
  const auto elements = detail::make_elements(scene_);
  gauss_tension_ = DeviceAndHost<GaussTension<Space>>("myowave::solver::gauss_tension", elements.elements());
  node_history_ = NodeHistory(elements, solves_of_metric(scene_));
  nodes_ = DeviceAndHost<Nodes<Space>>("myowave::solver::nodes", elements.nodes());
  element_areas_ =
      Kokkos::View<double*, Kokkos::HostSpace>("myowave::solver::element_areas", elements.elements());
  const detail::Timer timer(phases_->mechanics);
  equilibrium_.emplace(host_, elements, *scene_.mechanics);
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
    const detail::Timer timer(phases_->mechanics);
    if (equilibrium_->is_solved_for(host_, gauss_tension_.host))
      ++statistics_->left_out;
    else
      add_to_statistics(equilibrium_->solve(host_, gauss_tension_.host, t));
    moved = node_history_.add(t, equilibrium_->nodes());
  }
  if (place_nodes(t)) refresh_metric(t);
  if (moved) measure_area();
  area_.t = t;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::download_tension() {
  if (!contracts(scene_)) return;
  const detail::Timer timer(phases_->transfer);
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

// Before the first solve the nodes are all zero, which no sheet's are.
template <class ExecutionSpace, class Real>
bool Electromechanics<ExecutionSpace, Real>::place_nodes(double t) {
  const detail::Timer timer(phases_->transfer);
  const double middle = t + 0.5 * scene_.mechanics->interval * scene_.time.dt;
  const auto& placed = node_history_.at(middle);
  if (std::equal(placed.data(), placed.data() + placed.size(), nodes_.host.data())) return false;
  Kokkos::deep_copy(host_, nodes_.host, placed);
  host_.fence("myowave::solver::place_nodes");
  return true;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::refresh_metric(double t) {
  const detail::Timer timer(phases_->transfer);
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
  const detail::Timer timer(phases_->observe);
  observe::element_areas(host_, equilibrium_->grid(), node_history_.last(), element_areas_);
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
double Electromechanics<ExecutionSpace, Real>::largest_tension() const {
  const auto& Ta = gauss_tension_.host;
  return Ta.size() == 0 ? 0 : *std::max_element(Ta.data(), Ta.data() + Ta.size());
}

template <class ExecutionSpace, class Real>
std::vector<double> Electromechanics<ExecutionSpace, Real>::download_nodes() const {
  const auto& nodes = node_history_.last();
  return {nodes.data(), nodes.data() + nodes.size()};
}

}  // namespace myowave::solver
