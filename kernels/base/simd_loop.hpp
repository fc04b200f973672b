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

// The number itself, of which a host's compiler knows nothing more. It would carry one address after another
// through a loop, for each expression in the loop's counter, and where they are more than there are registers
// it is faster to make them anew.
KOKKOS_FORCEINLINE_FUNCTION int opaque(int number) {
  KOKKOS_IF_ON_HOST((asm("" : "+r"(number));))
  return number;
}

namespace detail {

// Bytes of one array: a line of the cache, and how much of a row runs between two rounds of hints.
inline constexpr int line_bytes = 64, block_bytes = 256;
template <class Real>
inline constexpr int line_of = line_bytes / static_cast<int>(sizeof(Real));
template <class Real>
inline constexpr int block_of = block_bytes / static_cast<int>(sizeof(Real));

// Inlined by force, with the body: a clone of it elsewhere would take what it refers to from memory, where
// each short row would have to put it.
template <class Body>
[[gnu::always_inline]] inline void simd_loop(int begin, int end, const Body& body) {
#pragma omp simd
  for (int j = begin; j < end; ++j) body(j);
}

// A line at a time, of a length that the compiler knows: it makes straight code of it, with fewer addresses,
// and nothing to find out before and after a short row. Returns the first column that fills no line.
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

// The same where a second body(j) does nothing new: columns that fill no line go in one that ends with the
// last. Where that begins is kept from the compiler: of a single line it would make scalar code.
template <class Real, class Body>
[[gnu::always_inline]] inline void simd_loop_again(int begin, int end, const Body& body) {
  if (end - begin < line_of<Real>) {  // rare, so in as little code as will do
    for (int j = begin; j < end; ++j) body(opaque(j));
    return;
  }
  if (simd_lines<Real>(begin, end, body) < end) simd_lines<Real>(opaque(end - line_of<Real>), end, body);
}

// A step has more streams, and more arithmetic between two lines of one, than a processor's own
// prefetcher keeps ahead of: from memory it is half as fast without hints. hint(j) is called once a line.
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
