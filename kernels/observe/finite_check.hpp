// The first grid node, in row-major order, where a state variable is not finite.
#pragma once

#include "kernels/base/views.hpp"

namespace myowave::observe {

// Linear index (member rows + row) columns + column of the first node where V, r or Ta (members,
// rows, columns) is not finite; -1 where all are. Waits for the result.
template <class ExecutionSpace, class View>
long first_non_finite(const ExecutionSpace& space, const View& V, const View& r, const View& Ta) {
  const int rows = static_cast<int>(V.extent(1)), columns = static_cast<int>(V.extent(2));
  constexpr long none = Kokkos::reduction_identity<long>::min();
  long first = none;
  Kokkos::parallel_reduce(
      "myowave::observe::first_non_finite",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(V.extent(0)) * rows),
      KOKKOS_LAMBDA(int row, long& smallest) {
        const int m = row / rows, i = row % rows;
        // 0 * x is 0 for a finite x and not a number otherwise: one SIMD sum tells of a whole row
        using Real = typename View::non_const_value_type;
        const Real *v = &V(m, i, 0), *s = &r(m, i, 0), *tension = &Ta(m, i, 0);
        Real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int j = 0; j < columns; ++j) sum += Real(0) * (v[j] + s[j] + tension[j]);
        if (sum == Real(0)) return;
        for (int j = 0; j < columns; ++j)
          if (!Kokkos::isfinite(v[j]) || !Kokkos::isfinite(s[j]) || !Kokkos::isfinite(tension[j])) {
            smallest = Kokkos::min(smallest, long(row) * columns + j);
            return;
          }
      },
      Kokkos::Min<long>(first));
  return first == none ? -1 : first;
}

}  // namespace myowave::observe
