#include "bench/plain/machine.hpp"

#include <algorithm>
#include <chrono>

namespace myowave::plain {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double b_value = 1, c_value = 2, scale = 3;

template <class Body>
double best_seconds(int repeats, const Body& body) {
  double best = 1e300;
  for (int n = 0; n < repeats; ++n) {
    const auto start = Clock::now();
    body();
    best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best;
}

}  // namespace

Triad::Triad(std::size_t size) : a_(size), b_(size), c_(size) {
#pragma omp parallel for simd schedule(static)
  for (std::size_t k = 0; k < size; ++k) b_[k] = b_value, c_[k] = c_value;
}

void Triad::operator()() const {
  const std::size_t size = a_.size();
  double* __restrict a = a_.data();
  const double* __restrict b = b_.data(), * __restrict c = c_.data();
#pragma omp parallel for simd schedule(static)
  for (std::size_t k = 0; k < size; ++k) a[k] = b[k] + scale * c[k];
}

bool Triad::is_right() const {
  return std::all_of(a_.data(), a_.data() + a_.size(),
                     [](double a) { return a == b_value + scale * c_value; });
}

double triad_bytes_per_s(std::size_t size, int repeats) {
  const Triad triad(size);
  triad();
  return triad_bytes * static_cast<double>(size) / best_seconds(repeats, [&] { triad(); });
}

namespace {

#if defined(__AVX512F__)
constexpr int width = 64;
#else
constexpr int width = 32;
#endif
constexpr int chains = 12;

template <class Real>
struct VectorOf;
template <>
struct VectorOf<double> {
  typedef double Type __attribute__((vector_size(width)));
};
template <>
struct VectorOf<float> {
  typedef float Type __attribute__((vector_size(width)));
};

template <class Vector, class Real>
Real multiply_and_add(int length) {
  // Enough independent chains to cover the latency of two units, few enough for the registers.
  Vector x[chains], factor, shift;
  constexpr int lanes = width / sizeof(Real);
  for (int l = 0; l < lanes; ++l) factor[l] = Real(0.5), shift[l] = Real(0.25) + Real(l);
  for (int c = 0; c < chains; ++c) x[c] = shift * Real(c);
  for (int n = 0; n < length; ++n)
    for (int c = 0; c < chains; ++c) x[c] = x[c] * factor + shift;
  Real sum = 0;
  for (int c = 0; c < chains; ++c)
    for (int l = 0; l < lanes; ++l) sum += x[c][l];
  return sum;
}

}  // namespace

template <class Real>
double peak_flops_per_s(int repeats) {
  constexpr int length = 200'000;
  int threads = 0;
  Real sum = 0;
  const double seconds = best_seconds(repeats, [&] {
    threads = 0;
#pragma omp parallel reduction(+ : sum, threads)
    {
      ++threads;
      sum += multiply_and_add<typename VectorOf<Real>::Type, Real>(length);
    }
  });
  const double flops = 2.0 * (width / sizeof(Real)) * chains * length * threads;
  return sum > 0 ? flops / seconds : 0;  // uses the sum, so that the compiler keeps the loop
}

template double peak_flops_per_s<double>(int);
template double peak_flops_per_s<float>(int);

}  // namespace myowave::plain
