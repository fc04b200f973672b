// Loops over neighbouring columns of one row: vector lanes on a device, SIMD on a host, where a Kokkos
// range alone does not vectorise.
#pragma once

#include "kernels/base/simd_loop.hpp"

namespace myowave {

template <class ExecutionSpace>
inline constexpr bool runs_on_host =
    Kokkos::SpaceAccessibility<ExecutionSpace, Kokkos::HostSpace>::accessible;

// Loops over the columns of a row:
//   each(begin, end, body)          body(j) for begin <= j < end, iterations independent of one another
//   each(begin, end, body, hint)    the same on fields; hint(j) prefetches what column j needs
//   each_again(begin, end, body)    the same; body(j) may run twice
//   each_of_whole_lines(end, body)  from 0 to `end`, a multiple of a line's entries
//   once(body)                      body() by one lane
//   wait()                          for writes of other lanes to the row; nothing on a host
//
// By the SIMD lanes of a host's thread, on fields of Real. Prefetches only fields that come from memory: in a
// cache the hints cost loads and, beyond a thread's own rows, lines that another thread writes.
template <class Real>
struct HostColumns {
  bool from_memory = false;

  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body) const {
    KOKKOS_IF_ON_HOST((detail::simd_loop_by_lines<Real>(begin, end, body);))
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each_again(int begin, int end, const Body& body) const {
    KOKKOS_IF_ON_HOST((detail::simd_loop_again<Real>(begin, end, body);))
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each_of_whole_lines(int end, const Body& body) const {
    KOKKOS_IF_ON_HOST((detail::simd_lines<Real>(0, end, body);))
  }
  template <class Body, class Hint>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body, const Hint& hint) const {
    KOKKOS_IF_ON_HOST((if (!from_memory) return each(begin, end, body);
                       detail::simd_loop_by_lines<Real>(begin, end, body, hint);))
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void once(const Body& body) const {
    body();
  }
  KOKKOS_FORCEINLINE_FUNCTION void wait() const {}
};

// By the vector lanes of one thread of a device's team.
template <class TeamMember>
struct ThreadColumns {
  const TeamMember& team;

  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body) const {
    Kokkos::parallel_for(Kokkos::ThreadVectorRange(team, begin, end), body);
  }
  template <class Body, class Hint>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body, const Hint&) const {
    each(begin, end, body);
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void once(const Body& body) const {
    Kokkos::single(Kokkos::PerThread(team), body);
  }
};

// By all threads of a device's team together; no barrier at the end.
template <class TeamMember>
struct TeamColumns {
  const TeamMember& team;

  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body) const {
    Kokkos::parallel_for(Kokkos::TeamVectorRange(team, begin, end), body);
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each_again(int begin, int end, const Body& body) const {
    each(begin, end, body);
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each_of_whole_lines(int end, const Body& body) const {
    each(0, end, body);
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void once(const Body& body) const {
    Kokkos::single(Kokkos::PerTeam(team), body);
  }
  KOKKOS_FORCEINLINE_FUNCTION void wait() const { team.team_barrier(); }
};

}  // namespace myowave
