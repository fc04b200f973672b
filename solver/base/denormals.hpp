// Flush denormal numbers to zero. V at rest decays without end; once it is denormal, a step costs
// many times as much on a host and gains nothing.
#pragma once

#include <Kokkos_Core.hpp>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace myowave::solver {

inline void flush_denormals_of_this_thread() {
#if defined(__SSE2__)
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  _mm_setcsr(_mm_getcsr() | flush_to_zero | denormals_are_zero);
#elif defined(__aarch64__)
  constexpr unsigned long flush_to_zero = 1ul << 24;
  unsigned long control;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  asm volatile("msr fpcr, %0" : : "r"(control | flush_to_zero));
#endif
}

// On every thread of the host's execution space and on the calling one.
template <class Host = Kokkos::DefaultHostExecutionSpace>
void flush_denormals(const Host& host = {}) {
  Kokkos::parallel_for(
      "myowave::solver::flush_denormals",
      Kokkos::RangePolicy<Host, Kokkos::Schedule<Kokkos::Static>>(host, 0, host.concurrency())
          .set_chunk_size(1),
      [](int) { flush_denormals_of_this_thread(); });
  flush_denormals_of_this_thread();
}

}  // namespace myowave::solver
