#include "solver/analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace myowave::solver {
namespace {

// Two-sided p of Student's distribution.
double p_of(double t, double degrees_of_freedom) {
  return regularized_incomplete_beta(0.5 * degrees_of_freedom, 0.5,
                                     degrees_of_freedom / (degrees_of_freedom + t * t));
}

// Converges fast where x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
  const auto not_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1, d = 1 / not_zero(1 - (a + b) * x / (a + 1)), fraction = d;
  constexpr int most_terms = 10000;  // about sqrt(max(a, b)) are needed
  for (int m = 1; m < most_terms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / not_zero(1 + even * d);
    c = not_zero(1 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / not_zero(1 + odd * d);
    c = not_zero(1 + odd / c);
    const double factor = d * c;
    fraction *= factor;
    if (std::abs(factor - 1) < std::numeric_limits<double>::epsilon()) break;
  }
  return fraction;
}

}  // namespace

MeanSd RunningStatistics::result() const {
  return {mean_, n_ > 1 ? std::sqrt(sum_of_squares_ / static_cast<double>(n_ - 1)) : 0.0, n_};
}

MeanSd mean_sd(std::span<const double> values) {
  RunningStatistics statistics;
  for (const double value : values)
    if (std::isfinite(value)) statistics.add(value);
  return statistics.result();
}

std::optional<double> integrated_correlation(std::span<const double> series) {
  if (series.size() < 2 || std::ranges::adjacent_find(series, std::not_equal_to<>()) == series.end())
    return std::nullopt;
  const std::size_t n = series.size();
  const double mean = std::accumulate(series.begin(), series.end(), 0.0) / static_cast<double>(n);
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t k = lag; k < n; ++k) sum += (series[k] - mean) * (series[k - lag] - mean);
    return sum;
  };
  constexpr double window = 5;
  const double variance = covariance(0);
  double tau = 1;
  for (std::size_t lag = 1; lag < n && static_cast<double>(lag) < window * tau; ++lag)
    tau += 2 * covariance(lag) / variance;
  return tau;
}

SeriesStatistics series_statistics(std::span<const double> series) {
  RunningStatistics moments;
  for (const double value : series) moments.add(value);
  SeriesStatistics result{moments.result(), integrated_correlation(series)};
  const double n = static_cast<double>(result.n);
  result.effective_n = result.correlation ? n / std::max(1.0, *result.correlation) : n;
  result.standard_error = result.n > 0 ? result.sd / std::sqrt(result.effective_n) : 0;
  return result;
}

std::optional<TTest> student_t_test(const MeanSd& a, const MeanSd& b) {
  const double na = static_cast<double>(a.n), nb = static_cast<double>(b.n), degrees = na + nb - 2;
  if (a.n < 1 || b.n < 1 || degrees < 1) return std::nullopt;
  const double pooled = ((na - 1) * a.sd * a.sd + (nb - 1) * b.sd * b.sd) / degrees;
  if (!(pooled > 0)) return std::nullopt;
  const double t = (a.mean - b.mean) / std::sqrt(pooled * (1 / na + 1 / nb));
  return TTest{t, degrees, p_of(t, degrees)};
}

std::optional<TTest> welch_t_test(const SeriesStatistics& a, const SeriesStatistics& b) {
  if (!(a.effective_n > 1) || !(b.effective_n > 1)) return std::nullopt;
  const double va = a.standard_error * a.standard_error, vb = b.standard_error * b.standard_error;
  if (!(va + vb > 0)) return std::nullopt;
  const double t = (a.mean - b.mean) / std::sqrt(va + vb);
  const double degrees =
      (va + vb) * (va + vb) / (va * va / (a.effective_n - 1) + vb * vb / (b.effective_n - 1));
  return TTest{t, degrees, p_of(t, degrees)};
}

double regularized_incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

}  // namespace myowave::solver
