// What the parts of Electromechanics share: timing its phases, its elements, parts of Views. Not for others.
#pragma once

#include <chrono>
#include <cstddef>
#include <utility>

#include "solver/coupling/electromechanics.hpp"

namespace myowave::solver::detail {

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

inline elastic::ElementGrid make_elements(const Scene& scene) {
  if (!scene.mechanics) return {};
  const int cells = scene.mechanics->cells_per_element;
  return {(scene.grid.rows - 1) / cells, (scene.grid.columns - 1) / cells, cells * scene.grid.dx};
}

// The used part of a View with spare capacity.
template <class DataType, class... Traits>
auto first_rows(const Kokkos::View<DataType, Traits...>& view, std::size_t rows) {
  const std::pair<std::size_t, std::size_t> range{0, rows};
  if constexpr (Kokkos::View<DataType, Traits...>::rank() == 1)
    return Kokkos::subview(view, range);
  else
    return Kokkos::subview(view, range, Kokkos::ALL);
}

}  // namespace myowave::solver::detail
