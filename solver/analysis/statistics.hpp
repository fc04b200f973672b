// Statistics of samples: moments, the correlation of a series, tests of two means.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "solver/base/sample_statistics.hpp"

namespace myowave::solver {

// Mean and sample standard deviation, accumulated without storing the samples (Welford).
class RunningStatistics {
 public:
  void add(double value) {
    ++n_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(n_);
    sum_of_squares_ += delta * (value - mean_);
  }
  MeanSd result() const;

 private:
  std::int64_t n_ = 0;
  double mean_ = 0, sum_of_squares_ = 0;
};

// Of the finite values.
MeanSd mean_sd(std::span<const double>);

// tau = 1 + 2 (rho(1) + ... + rho(M)) of the sample autocorrelation rho, with the self-consistent window of
// Sokal (Monte Carlo methods in statistical mechanics, 1997, section 3): M is the smallest that is at least
// 5 tau(M). Too small if the series is shorter than some 50 tau. None if all samples are equal.
std::optional<double> integrated_correlation(std::span<const double> series);

SeriesStatistics series_statistics(std::span<const double> series);

// Of a difference of two means.
struct TTest {
  double t = 0;
  double degrees_of_freedom = 0;
  double p = 1;  // two-sided
};

// Student's unpaired test: independent samples of one variance, pooled. None for fewer than three samples
// together or if neither varies.
std::optional<TTest> student_t_test(const MeanSd&, const MeanSd&);

// Welch's: variances may differ (Welch-Satterthwaite degrees of freedom). For correlated series pass the
// effective sizes. None if one is not above 1, or if neither varies.
std::optional<TTest> welch_t_test(const SeriesStatistics&, const SeriesStatistics&);

// I_x(a, b) for a, b > 0 and 0 <= x <= 1, to about 1e-14: continued fraction (DLMF 8.17.22) by the modified
// Lentz method, as in Press et al., Numerical Recipes, section 6.4.
double regularized_incomplete_beta(double a, double b, double x);

}  // namespace myowave::solver
