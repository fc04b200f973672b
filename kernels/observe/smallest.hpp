// The smallest value of a field.
#pragma once

#include "kernels/base/views.hpp"

namespace myowave::observe {

// Of all members (members, rows, columns); waits for the result.
template <class ExecutionSpace, class View>
double smallest(const ExecutionSpace& space, const View& field) {
  const int rows = static_cast<int>(field.extent(1)), columns = static_cast<int>(field.extent(2));
  double result = 0;
  Kokkos::parallel_reduce(
      "myowave::observe::smallest",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(field.extent(0)) * rows),
      KOKKOS_LAMBDA(int row, double& min) {
        const auto* const values = &field(row / rows, row % rows, 0);
        auto low = values[0];
#pragma omp simd reduction(min : low)
        for (int j = 1; j < columns; ++j) low = values[j] < low ? values[j] : low;
        min = Kokkos::min(min, double(low));
      },
      Kokkos::Min<double>(result));
  return result;
}

}  // namespace myowave::observe
