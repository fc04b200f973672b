// Flushes denormal numbers to zero. V at rest decays without end; once it is denormal, a step costs
// many times as much on a host and gains nothing.
#pragma once

#include <Kokkos_Core.hpp>
#include <cstdint>
#include <vector>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace myowave::solver {

// The control bits of a thread's floating-point unit that decide about denormals; elsewhere there are none.
#if defined(__SSE2__)
inline constexpr std::uint64_t flush_bits = 0x8000 | 0x0040;  // of results, of operands
inline std::uint64_t float_control() { return _mm_getcsr(); }
inline void set_float_control(std::uint64_t bits) { _mm_setcsr(static_cast<unsigned>(bits)); }
#elif defined(__aarch64__)
inline constexpr std::uint64_t flush_bits = 1ul << 24;
inline std::uint64_t float_control() {
  std::uint64_t bits;
  asm volatile("mrs %0, fpcr" : "=r"(bits));
  return bits;
}
inline void set_float_control(std::uint64_t bits) { asm volatile("msr fpcr, %0" : : "r"(bits)); }
#else
inline constexpr std::uint64_t flush_bits = 0;
inline std::uint64_t float_control() { return 0; }
inline void set_float_control(std::uint64_t) {}
#endif

// Of the calling thread: those of flush_bits that are set.
inline std::uint64_t denormal_mode() { return float_control() & flush_bits; }
inline void set_denormal_mode(std::uint64_t mode) {
  set_float_control((float_control() & ~flush_bits) | mode);
}

// Flushes denormals on the calling thread and on every thread of the host instance while it exists. Its
// destructor gives each thread the mode that it had before. Construct and destroy it on one thread, before
// Kokkos is finalized.
template <class Host = Kokkos::DefaultHostExecutionSpace>
class FlushDenormals {
 public:
  explicit FlushDenormals(const Host& host = {})
      : host_(host), own_mode_(denormal_mode()), modes_(host.concurrency()) {
    on_each_thread("myowave::solver::flush_denormals", [modes = modes_.data()](int thread) {
      modes[thread] = denormal_mode();
      set_denormal_mode(flush_bits);
    });
    set_denormal_mode(flush_bits);
  }
  ~FlushDenormals() {
    on_each_thread("myowave::solver::restore_denormals",
                   [modes = modes_.data()](int thread) { set_denormal_mode(modes[thread]); });
    set_denormal_mode(own_mode_);
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  template <class Action>
  void on_each_thread(const char* label, const Action& action) const {
    Kokkos::parallel_for(
        label,
        Kokkos::RangePolicy<Host, Kokkos::Schedule<Kokkos::Static>>(host_, 0, static_cast<int>(modes_.size()))
            .set_chunk_size(1),
        action);
  }

  Host host_;
  std::uint64_t own_mode_;
  std::vector<std::uint64_t> modes_;  // by thread of the instance
};

}  // namespace myowave::solver
