// Peaks of the machine, measured in this process: memory bandwidth and arithmetic.
#pragma once

#include <cstddef>

#include "bench/plain/step.hpp"

namespace myowave::plain {

// STREAM's third loop, a = b + s c, on all threads.
class Triad {
 public:
  explicit Triad(std::size_t size);
  void operator()() const;
  std::size_t size() const { return a_.size(); }
  // Whether every entry is right.
  bool is_right() const;

 private:
  Array<double> a_, b_, c_;
};

// Bytes that one entry moves on a host: two reads, the line of `a` read for ownership, one write.
// STREAM itself counts 24.
inline constexpr double triad_bytes = 32;

// Best of `repeats`, triad_bytes an entry.
double triad_bytes_per_s(std::size_t size, int repeats);

// Fused multiply-adds on registers, all threads, two operations each; best of `repeats`.
template <class Real>
double peak_flops_per_s(int repeats);

}  // namespace myowave::plain
