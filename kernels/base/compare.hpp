// Comparisons of a few neighbouring values at once, a bit each. Compilers make no mask of a loop.
#pragma once

#include <cstdint>

#if defined(__AVX512F__) || defined(__AVX__)
#include <immintrin.h>
#endif

namespace myowave {

// Values that not_below() takes.
#if defined(__AVX512F__)
template <class Real>
inline constexpr int compared_together = 64 / sizeof(Real);
#else
template <class Real>
inline constexpr int compared_together = 32 / sizeof(Real);
#endif

// Bit k: values[k] >= level. Of a host.
inline std::uint64_t not_below(const double* values, double level) {
#if defined(__AVX512F__)
  return _mm512_cmp_pd_mask(_mm512_loadu_pd(values), _mm512_set1_pd(level), _CMP_GE_OQ);
#elif defined(__AVX__)
  return _mm256_movemask_pd(_mm256_cmp_pd(_mm256_loadu_pd(values), _mm256_set1_pd(level), _CMP_GE_OQ));
#else
  std::uint64_t bits = 0;
  for (int k = 0; k < compared_together<double>; ++k) bits |= std::uint64_t(values[k] >= level ? 1 : 0) << k;
  return bits;
#endif
}

inline std::uint64_t not_below(const float* values, float level) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask(_mm512_loadu_ps(values), _mm512_set1_ps(level), _CMP_GE_OQ);
#elif defined(__AVX__)
  return _mm256_movemask_ps(_mm256_cmp_ps(_mm256_loadu_ps(values), _mm256_set1_ps(level), _CMP_GE_OQ));
#else
  std::uint64_t bits = 0;
  for (int k = 0; k < compared_together<float>; ++k) bits |= std::uint64_t(values[k] >= level ? 1 : 0) << k;
  return bits;
#endif
}

}  // namespace myowave
