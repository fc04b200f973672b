// Loops over neighbouring columns of one row: vector lanes on a device, SIMD on a host, where a Kokkos
// range alone does not vectorise.
#pragma once

#include <Kokkos_Core.hpp>

namespace myowave {

template <class ExecutionSpace>
inline constexpr bool runs_on_host =
    Kokkos::SpaceAccessibility<ExecutionSpace, Kokkos::HostSpace>::accessible;

// Hints that a line of memory will be read, or written, soon; nothing on a device.
KOKKOS_FORCEINLINE_FUNCTION void prefetch_to_read([[maybe_unused]] const void* address) {
  KOKKOS_IF_ON_HOST((__builtin_prefetch(address, 0);))
}
KOKKOS_FORCEINLINE_FUNCTION void prefetch_to_write([[maybe_unused]] const void* address) {
  KOKKOS_IF_ON_HOST((__builtin_prefetch(address, 1);))
}

namespace detail {

// Bytes of one array: a line of the cache, and how much of a row runs between two rounds of hints.
inline constexpr int line_bytes = 64, block_bytes = 256;

template <class Body>
inline void simd_loop(int begin, int end, const Body& body) {
#pragma omp simd
  for (int j = begin; j < end; ++j) body(j);
}

// A step has more streams, and more arithmetic between two lines of one, than a processor's own
// prefetcher keeps ahead of: from memory it is half as fast without hints. hint(j) is called once a line.
template <class Real, class Body, class Hint>
inline void simd_loop(int begin, int end, const Body& body, const Hint& hint) {
  constexpr int line = line_bytes / sizeof(Real), block = block_bytes / sizeof(Real);  // columns
  for (int first = begin; first < end; first += block) {
    const int last = first + block < end ? first + block : end;
    for (int j = first; j < last; j += line) hint(j);
    simd_loop(first, last, body);
  }
}

}  // namespace detail

// How the columns of a row are looped over:
//   each(begin, end, body)         body(j) for begin <= j < end, iterations independent of one another
//   each<Real>(..., body, hint)    the same on fields in memory; hint(j) prefetches what column j needs
//   once(body)                     body() by one lane
//   wait()                         for what others have written to the row; there are none on a host
//
// By the SIMD lanes of a host's thread.
struct HostColumns {
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body) const {
    KOKKOS_IF_ON_HOST((detail::simd_loop(begin, end, body);))
  }
  template <class Real, class Body, class Hint>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body, const Hint& hint) const {
    KOKKOS_IF_ON_HOST((detail::simd_loop<Real>(begin, end, body, hint);))
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
  template <class Real, class Body, class Hint>
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
  template <class Real, class Body, class Hint>
  KOKKOS_FORCEINLINE_FUNCTION void each(int begin, int end, const Body& body, const Hint&) const {
    each(begin, end, body);
  }
  template <class Body>
  KOKKOS_FORCEINLINE_FUNCTION void once(const Body& body) const {
    Kokkos::single(Kokkos::PerTeam(team), body);
  }
  KOKKOS_FORCEINLINE_FUNCTION void wait() const { team.team_barrier(); }
};

}  // namespace myowave
