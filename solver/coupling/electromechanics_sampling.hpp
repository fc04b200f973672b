// Electromechanics: checks, tips, probes and maps of its state. Included by its instantiations only.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <variant>

#include "kernels/observe/probes.hpp"
#include "solver/base/beat.hpp"
#include "solver/base/host_copy.hpp"
#include "solver/coupling/electromechanics_common.hpp"
#include "solver/excitation/state_check.hpp"

namespace myowave::solver {

namespace detail {

// Maps and probes define beats alike.
inline constexpr observe::ActivationLevels beat_levels{static_cast<float>(BeatLevels::upstroke),
                                                       static_cast<float>(BeatLevels::rearm),
                                                       static_cast<float>(BeatLevels::apd)};

inline auto values_of(const tissue::ActiveStimulus& stimulus) {
  const auto& r = stimulus.region;
  return std::tuple(r.row_begin, r.row_end, r.column_begin, r.column_end, r.center_row, r.center_column,
                    r.radius2, stimulus.amplitude);
}

}  // namespace detail

template <class ExecutionSpace, class Real>
std::optional<std::string> Electromechanics<ExecutionSpace, Real>::check_state(double t, double dt) {
  const detail::Timer timer(phases_->observe);
  const auto growing_noise = [&] {
    upload_stimuli(schedule_.active(t));
    return std::visit(
        [&](const auto& form) {
          using Rate = tissue::MonodomainRate<std::decay_t<decltype(form.diffusion)>, Model<Real>>;
          const Rate rate{form.diffusion, model_, state_.V, state_.r,
                          detail::first_rows(stimuli_, uploaded_stimuli_.size())};
          return observe::growing_noise(space_, state_.V, rate, dt, largest_clean_noise);
        },
        form_);
  };
  return solver::check_state(space_, WatchedState<View>{state_, t}, clean_.with_margin(scene_),
                             growing_noise);
}

template <class ExecutionSpace, class Real>
auto Electromechanics<ExecutionSpace, Real>::find_tips(double t) -> Activity {
  const detail::Timer timer(phases_->observe);
  upload_stimuli(schedule_.active(t));
  const auto find = [&] {
    Kokkos::deep_copy(space_, tip_count_.device, 0);
    const double largest_V = std::visit(
        [&](const auto& form) {
          using Rate = tissue::MonodomainRate<std::decay_t<decltype(form.diffusion)>, Model<Real>>;
          const Rate rate{form.diffusion, model_, state_.V, state_.r,
                          detail::first_rows(stimuli_, uploaded_stimuli_.size())};
          return observe::find_phase_singularities(space_, grid_, state_.V, rate, tip_count_.device,
                                                   tip_list_.device);
        },
        form_);
    Kokkos::deep_copy(space_, tip_count_.host, tip_count_.device);
    space_.fence("myowave::solver::find_tips");
    return largest_V;
  };
  Activity activity;
  activity.largest_V = find();
  const auto found = static_cast<std::size_t>(tip_count_.host());
  if (found > tip_list_.device.extent(0)) {  // again, with room for them
    tip_list_ = DeviceAndHost<Kokkos::View<observe::PhaseSingularity*, Space>>("myowave::solver::tip_list",
                                                                               2 * found);
    find();
  }
  const auto list = detail::first_rows(tip_list_.host, found);
  Kokkos::deep_copy(space_, list, detail::first_rows(tip_list_.device, found));
  space_.fence("myowave::solver::find_tips");
  std::vector<observe::PhaseSingularity> sorted(list.data(), list.data() + found);
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::pair{a.row, a.column} < std::pair{b.row, b.column};
  });
  for (const auto& tip : sorted) activity.tips.push_back({tip.x, tip.y, tip.charge});
  return activity;
}

template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::sample_activation(double t) {
  const detail::Timer timer(phases_->observe);
  if (activation_sampled_)
    observe::sample_activation(
        space_, state_.V,
        observe::ActivationInterval{*activation_sampled_, t, scene_.output.period_from, detail::beat_levels},
        activation_);
  else
    observe::begin_activation(space_, state_.V, activation_, detail::beat_levels);
  space_.fence("myowave::solver::sample_activation");
  activation_sampled_ = t;
}

template <class ExecutionSpace, class Real>
ActivationMaps Electromechanics<ExecutionSpace, Real>::activation_maps() const {
  const detail::Timer timer(phases_->observe);
  const auto records = host_copy(space_, activation_.records);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  ActivationMaps maps;
  maps.rows = grid_.rows;
  maps.columns = grid_.columns;
  maps.dx = grid_.dx;
  maps.apd_level = BeatLevels::apd;
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
  return maps;
}

// Successive samples often find the same stimuli: none, or those of a long pulse.
template <class ExecutionSpace, class Real>
void Electromechanics<ExecutionSpace, Real>::upload_stimuli(
    const std::vector<tissue::ActiveStimulus>& active) {
  if (std::ranges::equal(active, uploaded_stimuli_, {}, detail::values_of, detail::values_of)) return;
  uploaded_stimuli_ = active;
  if (active.empty()) return;
  Kokkos::deep_copy(space_, detail::first_rows(stimuli_, active.size()),
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

}  // namespace myowave::solver
