// The check of a state: finite, within range, free of growing grid-scale noise.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kernels/observe/state_check.hpp"
#include "kernels/tissue/tiled_step.hpp"
#include "solver/excitation/stability.hpp"

namespace myowave::solver {

// The state of a sheet at time t (t.u.), one member; Ta may be without memory.
template <class View>
struct WatchedState {
  const tissue::ExcitationFields<View>& fields;
  double t;

  // "t = 3 t.u.: `what` at node (row 1, column 2): V = 0.1, r = 0, Ta = 0"
  std::string text(const std::string& what, long node) const {
    const auto columns = static_cast<long>(fields.V.extent(2));
    const long row = node / columns, column = node % columns;
    const auto value = [&](const View& view) {
      if (view.size() == 0) return 0.0;
      typename View::non_const_value_type host;
      Kokkos::deep_copy(host, Kokkos::subview(view, 0, row, column));
      return static_cast<double>(host);
    };
    return fmt::format("t = {:.6g} t.u.: {} at node (row {}, column {}): V = {:.6g}, r = {:.6g}, Ta = {:.6g}",
                       t, what, row, column, value(fields.V), value(fields.r), value(fields.Ta));
  }

  std::string out_of_range(const View& view, const char* name, double low, double high) const {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
    const auto beyond = [&](double value) { return std::max(low - value, value - high); };
    const auto* const worst = std::ranges::max_element(host.data(), host.data() + host.size(), {}, beyond);
    return text(fmt::format("{} is outside of {:.3g} to {:.3g}, what the equations allow,", name, low, high),
                worst - host.data());
  }
};

// Describes the first problem found in a state: V, r or Ta is not finite, V or r is out of range, or V
// alternates at the grid's scale and keeps doing so. Empty for a valid state. `growing`: called if the
// noise is too large, returns the observe::GrowingNoise.
template <class ExecutionSpace, class View, class Growing>
std::optional<std::string> check_state(const ExecutionSpace& space, const WatchedState<View>& state,
                                       const CleanRange& range, const Growing& growing) {
  const auto& [V, r, Ta] = state.fields;
  const observe::InspectedState found = observe::inspect_state(space, V, r, Ta);
  if (found.first_non_finite >= 0) return state.text("the excitation is not finite", found.first_non_finite);
  if (found.min_V < range.min_V || found.max_V > range.max_V)
    return state.out_of_range(V, "V", range.min_V, range.max_V);
  if (found.min_r < range.min_r)
    return state.out_of_range(r, "r", range.min_r, std::numeric_limits<double>::infinity());

  if (found.noise < largest_clean_noise) return std::nullopt;
  const observe::GrowingNoise noise = growing();
  if (noise.node < 0) return std::nullopt;
  return state.text(
      fmt::format("V alternates by {:.3g} from node to node and from step to step", noise.noise), noise.node);
}

}  // namespace myowave::solver
