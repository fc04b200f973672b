// A loop over neighbouring columns of one row: vector lanes on a device, SIMD on a host, where a
// Kokkos range alone does not vectorise.
#pragma once

#include <Kokkos_Core.hpp>

namespace myowave {
namespace detail {

template <class Body>
inline void simd_loop(int begin, int end, const Body& body) {
#pragma omp simd
  for (int j = begin; j < end; ++j) body(j);
}

}  // namespace detail

// body(j) for begin <= j < end; the iterations must not depend on one another.
template <class TeamMember, class Body>
KOKKOS_FORCEINLINE_FUNCTION void for_columns([[maybe_unused]] const TeamMember& team, int begin, int end,
                                             const Body& body) {
  KOKKOS_IF_ON_DEVICE((Kokkos::parallel_for(Kokkos::ThreadVectorRange(team, begin, end), body);))
  KOKKOS_IF_ON_HOST((detail::simd_loop(begin, end, body);))
}

}  // namespace myowave
