// A loop over all elements or nodes of a mesh: one thread each on a device, vector lanes along a row on a
// host.
#pragma once

#include <Kokkos_Core.hpp>
#include <string>

namespace myowave::elastic {
namespace detail {

// body(I, J) by its place I columns + J.
template <class Body>
struct ByPlace {
  Body body;
  int columns;
  KOKKOS_FUNCTION void operator()(int place) const { body(place / columns, place % columns); }
};

// Row I in blocks of a fixed number of lanes, without a scalar loop for the remainder: the last block of a
// row starts early and computes some columns twice, with bitwise identical results.
template <class Body>
struct ByRow {
  static constexpr int lanes = 8;  // doubles of the widest vector register

  Body body;
  int columns;
  void operator()(int I) const {
    const Body row = body;  // a local copy, so that the compiler knows that no store changes it
    if (columns < lanes) {
      for (int J = 0; J < columns; ++J) row(I, J);
      return;
    }
    for (int begin = 0; begin < columns; begin += lanes) {
      const int first = begin + lanes <= columns ? begin : columns - lanes;
#pragma omp simd
      for (int lane = 0; lane < lanes; ++lane) row(I, first + lane);
    }
  }
};

}  // namespace detail

// body(I, J) for 0 <= I < rows, 0 <= J < columns; the calls must not depend on one another.
template <class Space, class Body>
void for_columns_of_rows(const std::string& label, const Space& space, int rows, int columns,
                         const Body& body) {
  using Policy = Kokkos::RangePolicy<Space>;
  if constexpr (Kokkos::SpaceAccessibility<Space, Kokkos::HostSpace>::accessible)
    Kokkos::parallel_for(label, Policy(space, 0, rows), detail::ByRow<Body>{body, columns});
  else
    Kokkos::parallel_for(label, Policy(space, 0, rows * columns), detail::ByPlace<Body>{body, columns});
}

}  // namespace myowave::elastic
