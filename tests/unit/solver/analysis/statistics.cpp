#include "solver/analysis/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace myowave::solver {
namespace {

MeanSd moments(std::span<const double> values) {
  RunningStatistics statistics;
  for (const double value : values) statistics.add(value);
  return statistics.result();
}

// x(n) = phi x(n-1) + e, e normal with variance 1: rho(k) = phi^k, tau = (1 + phi) / (1 - phi).
std::vector<double> autoregressive(double phi, int n, unsigned seed) {
  std::mt19937 bits(seed);
  std::normal_distribution<double> normal;
  std::vector<double> series;
  double x = normal(bits) / std::sqrt(1 - phi * phi);
  for (int k = 0; k < n; ++k) {
    series.push_back(x);
    x = phi * x + normal(bits);
  }
  return series;
}

TEST(MeanSd, IsOfTheFiniteValues) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MeanSd result = mean_sd(std::vector{nan, 1.0, 3.0, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(result.n, 2);
  EXPECT_EQ(result.mean, 2);
  EXPECT_DOUBLE_EQ(result.sd, std::sqrt(2));
  EXPECT_EQ(mean_sd({}).n, 0);
}

TEST(RunningStatistics, MeanAndSampleDeviationOfAHandCase) {
  RunningStatistics s;
  EXPECT_EQ(s.result().n, 0);
  s.add(3);
  EXPECT_EQ(s.result().n, 1);
  EXPECT_EQ(s.result().mean, 3);
  EXPECT_EQ(s.result().sd, 0);
  for (const double value : {5.0, 7.0, 9.0}) s.add(value);
  EXPECT_EQ(s.result().n, 4);
  EXPECT_DOUBLE_EQ(s.result().mean, 6);
  EXPECT_DOUBLE_EQ(s.result().sd, std::sqrt(20.0 / 3));
}

TEST(RunningStatistics, KeepsASmallSpreadOnALargeMean) {
  RunningStatistics s;
  for (int n = 0; n < 1000; ++n) s.add(1e9 + (n % 2));
  EXPECT_NEAR(s.result().sd, 0.5 * std::sqrt(1000.0 / 999), 1e-9);
}

TEST(IntegratedCorrelation, OfAnAutoregressiveProcessIsKnown) {
  for (const double phi : {0.0, 0.5, 0.9, 0.97}) {
    const double tau = (1 + phi) / (1 - phi);
    constexpr int n = 200000;
    // Sokal, equation 3.19: the relative error is sqrt(2 (2 M + 1) / n), M the window.
    const double error = std::sqrt(2 * (10 * tau + 1) / n);
    EXPECT_NEAR(*integrated_correlation(autoregressive(phi, n, 7)) / tau, 1, 3 * error) << phi;
  }
}

TEST(IntegratedCorrelation, OfEqualSamplesIsUnknown) {
  EXPECT_FALSE(integrated_correlation(std::vector<double>(100, 0.1)));
  EXPECT_FALSE(integrated_correlation(std::vector<double>{3.0}));
  EXPECT_FALSE(integrated_correlation({}));
}

TEST(SeriesStatistics, GiveTheEffectiveSampleSize) {
  const auto s = series_statistics(autoregressive(0.9, 100000, 3));
  EXPECT_EQ(s.n, 100000);
  EXPECT_NEAR(s.sd, 1 / std::sqrt(1 - 0.81), 0.05);
  EXPECT_DOUBLE_EQ(s.effective_n, 100000 / *s.correlation);
  EXPECT_DOUBLE_EQ(s.standard_error, s.sd / std::sqrt(s.effective_n));
  // Anticorrelated samples count as independent, not as more than there are.
  EXPECT_EQ(series_statistics(autoregressive(-0.5, 1000, 3)).effective_n, 1000);
  const auto constant = series_statistics(std::vector<double>(50, 1.0));
  EXPECT_EQ(constant.mean, 1);
  EXPECT_EQ(constant.standard_error, 0);
  EXPECT_EQ(constant.effective_n, 50);
}

// Student's own example, hours of sleep gained by two drugs (Biometrika 6, 1908); R's t.test gives these.
TEST(TTest, OfStudentsSleepData) {
  const std::array first{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
  const std::array second{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  const auto pooled = student_t_test(moments(first), moments(second));
  ASSERT_TRUE(pooled);
  EXPECT_NEAR(pooled->t, -1.8608, 5e-5);
  EXPECT_EQ(pooled->degrees_of_freedom, 18);
  EXPECT_NEAR(pooled->p, 0.07919, 5e-6);
  const auto independent = [](const auto& values) {
    const MeanSd m = moments(values);
    const double n = static_cast<double>(m.n);
    return SeriesStatistics{m, 1, n, m.sd / std::sqrt(n)};
  };
  const auto welch = welch_t_test(independent(first), independent(second));
  ASSERT_TRUE(welch);
  EXPECT_NEAR(welch->t, -1.8608, 5e-5);
  EXPECT_NEAR(welch->degrees_of_freedom, 17.776, 5e-4);
  EXPECT_NEAR(welch->p, 0.07939, 5e-6);
}

TEST(TTest, OfTheSameMeanIsOne) {
  const MeanSd a{3, 1, 10}, b{3, 2, 20};
  EXPECT_EQ(student_t_test(a, b)->t, 0);
  EXPECT_EQ(student_t_test(a, b)->p, 1);
}

TEST(TTest, OfTooFewOrEqualSamplesIsNone) {
  EXPECT_FALSE(student_t_test({1, 0, 1}, {2, 0, 1}));
  EXPECT_FALSE(student_t_test({1, 0, 5}, {2, 0, 5}));
  EXPECT_FALSE(student_t_test({}, {2, 1, 5}));
  EXPECT_FALSE(welch_t_test(series_statistics(std::vector<double>(9, 1.0)),
                            series_statistics(std::vector<double>(9, 2.0))));
  EXPECT_FALSE(welch_t_test(series_statistics({}), series_statistics(std::vector{1.0, 2.0, 4.0})));
}

// Two series of the same mean: a test at the 5 % level may find a difference in 5 % of them.
TEST(TTest, OnlyTheOneWithCorrelationHasItsNominalLevel) {
  constexpr int pairs = 300;
  int student = 0, welch = 0;
  for (unsigned k = 0; k < pairs; ++k) {
    const auto a = series_statistics(autoregressive(0.95, 4000, 2 * k));
    const auto b = series_statistics(autoregressive(0.95, 4000, 2 * k + 1));
    student += student_t_test(a, b)->p < 0.05 ? 1 : 0;
    welch += welch_t_test(a, b)->p < 0.05 ? 1 : 0;
  }
  // Student's statistic has sqrt(39) times the spread that the test assumes.
  EXPECT_NEAR(static_cast<double>(student) / pairs, std::erfc(1.96 / std::sqrt(2 * 39.0)), 0.09);
  EXPECT_NEAR(static_cast<double>(welch) / pairs, 0.05, 0.04);
}

TEST(IncompleteBeta, ClosedForms) {
  for (const double x : {0.0, 1e-9, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0}) {
    EXPECT_NEAR(regularized_incomplete_beta(0.5, 0.5, x), 2 / std::numbers::pi * std::asin(std::sqrt(x)),
                1e-14);
    EXPECT_NEAR(regularized_incomplete_beta(1, 7.5, x), 1 - std::pow(1 - x, 7.5), 1e-14);
    EXPECT_NEAR(regularized_incomplete_beta(40, 1, x), std::pow(x, 40), 1e-14);
    EXPECT_NEAR(regularized_incomplete_beta(3, 2, x), x * x * x * (4 - 3 * x), 1e-14);
    EXPECT_NEAR(regularized_incomplete_beta(8000, 0.5, x) + regularized_incomplete_beta(0.5, 8000, 1 - x), 1,
                1e-11);
  }
  for (const double a : {0.5, 3.0, 1e5}) EXPECT_NEAR(regularized_incomplete_beta(a, a, 0.5), 0.5, 1e-10) << a;
}

// With one and two degrees of freedom Student's distribution is elementary, with many it is the normal one.
TEST(TTest, TailsAreThoseOfStudentsDistribution) {
  for (const double t : {0.1, 1.0, 12.706, 63.657}) {
    EXPECT_NEAR(regularized_incomplete_beta(0.5, 0.5, 1 / (1 + t * t)),
                1 - 2 / std::numbers::pi * std::atan(t), 1e-14);
    EXPECT_NEAR(regularized_incomplete_beta(1, 0.5, 2 / (2 + t * t)), 1 - t / std::sqrt(2 + t * t), 1e-14);
  }
  const MeanSd a{1.96 * std::sqrt(2 / 1e6), 1, 1000000}, b{0, 1, 1000000};
  EXPECT_NEAR(student_t_test(a, b)->p, std::erfc(1.96 / std::numbers::sqrt2), 1e-6);
}

}  // namespace
}  // namespace myowave::solver
