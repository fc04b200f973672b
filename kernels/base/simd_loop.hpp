// Loops over neighbouring columns of one row in the SIMD lanes of a host's thread, and hints to fetch memory.
#pragma once

#include <Kokkos_Core.hpp>

namespace myowave {

// Hints that a line of memory will be read, or written, soon; nothing on a device.
KOKKOS_FORCEINLINE_FUNCTION void prefetch_to_read([[maybe_unused]] const void* address) {
  KOKKOS_IF_ON_HOST((__builtin_prefetch(address, 0);))
}
KOKKOS_FORCEINLINE_FUNCTION void prefetch_to_write([[maybe_unused]] const void* address) {
  KOKKOS_IF_ON_HOST((__builtin_prefetch(address, 1);))
}

// Hides the value from a host's compiler, so that it recomputes addresses instead of spilling pointers: else
// GCC carries a pointer through a loop for each expression in the loop's counter, more than there are
// registers.
KOKKOS_FORCEINLINE_FUNCTION int opaque(int number) {
  KOKKOS_IF_ON_HOST((asm("" : "+r"(number));))
  return number;
}

namespace detail {

// Bytes of a cache line, and of the part of a row between two rounds of prefetches.
inline constexpr int line_bytes = 64, block_bytes = 256;
template <class Real>
inline constexpr int line_of = line_bytes / static_cast<int>(sizeof(Real));
template <class Real>
inline constexpr int block_of = block_bytes / static_cast<int>(sizeof(Real));

// Inlined by force, with the body: an outlined clone would read the captured values from memory, and each
// short row would have to store them there.
template <class Body>
[[gnu::always_inline]] inline void simd_loop(int begin, int end, const Body& body) {
#pragma omp simd
  for (int j = begin; j < end; ++j) body(j);
}

// One cache line at a time: with a compile-time length the loop becomes straight code with fewer addresses
// and no prologue or epilogue. Returns the first column of the incomplete line.
template <class Real, class Body>
[[gnu::always_inline]] inline int simd_lines(int begin, int end, const Body& body) {
  int j = begin;
  for (; j + line_of<Real> <= end; j += line_of<Real>) simd_loop(j, j + line_of<Real>, body);
  return j;
}

template <class Real, class Body>
inline void simd_loop_by_lines(int begin, int end, const Body& body) {
  simd_loop(simd_lines<Real>(begin, end, body), end, body);
}

// The same where body(j) may run twice: the incomplete line is replaced by a whole one that ends with the
// last column. Its start is hidden from the compiler, which would else make scalar code of a single line.
template <class Real, class Body>
[[gnu::always_inline]] inline void simd_loop_again(int begin, int end, const Body& body) {
  if (end - begin < line_of<Real>) {  // rare: small code
    for (int j = begin; j < end; ++j) body(opaque(j));
    return;
  }
  if (simd_lines<Real>(begin, end, body) < end) simd_lines<Real>(opaque(end - line_of<Real>), end, body);
}

// A step has more streams, and more arithmetic between two lines of one, than a processor's own prefetcher
// handles. hint(j) is called once a line.
template <class Real, class Body, class Hint>
inline void simd_loop_by_lines(int begin, int end, const Body& body, const Hint& hint) {
  for (int first = begin; first < end; first += block_of<Real>) {
    const int last = first + block_of<Real> < end ? first + block_of<Real> : end;
    for (int j = first; j < last; j += line_of<Real>) hint(j);
    simd_loop_by_lines<Real>(first, last, body);
  }
}

}  // namespace detail

}  // namespace myowave
