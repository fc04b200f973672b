#include "solver/mechanics/linear/banded_ldlt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/reference_ldlt.hpp"
#include "tests/support/sheets.hpp"

namespace myowave::solver {
namespace {

// With all entries of the band.
reference::SymmetricMatrix band_matrix(int n, int band, double diagonal, unsigned seed) {
  test::Uniform uniform(seed);
  reference::SymmetricMatrix A;
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - band); j <= i; ++j) {
      A.column.push_back(j);
      A.values.push_back(uniform(-1, 1) + (i == j ? diagonal : 0));
    }
    A.row_begin.push_back(static_cast<int>(A.column.size()));
  }
  return A;
}

// Sizes near multiples of the block of eight columns, bands from none to full.
TEST(BandedLdlt, SolvesEverySizeAndBand) {
  for (const int n : {1, 2, 7, 8, 9, 15, 16, 17, 40, 83})
    for (const int band : {0, 1, 2, 7, 8, 9, 20, 39, 82}) {
      if (band >= n) continue;
      const auto A = band_matrix(n, band, 2.0 * band + 2, 100 * n + band);
      BandedLdlt factor(A.row_begin, A.column);
      ASSERT_EQ(factor.factorize(A.values), Factorization::positive_definite) << n << ' ' << band;
      std::vector<double> x(n), found(n);
      for (int i = 0; i < n; ++i) x[i] = 1 + i % 3;
      factor.solve(product(A, x), found);
      for (int i = 0; i < n; ++i) ASSERT_NEAR(found[i], x[i], 1e-13) << n << ' ' << band << ' ' << i;
    }
}

TEST(BandedLdlt, FactorsAgainWithOtherValues) {
  const auto A = band_matrix(50, 11, 30, 1), B = band_matrix(50, 11, 40, 2);
  BandedLdlt factor(A.row_begin, A.column);
  factor.factorize(A.values);
  factor.factorize(B.values);
  const std::vector<double> x(50, 1.0);
  std::vector<double> found(50);
  factor.solve(product(B, x), found);
  for (const double value : found) EXPECT_NEAR(value, 1, 1e-13);
}

TEST(BandedLdlt, DistinguishesIndefiniteFromFailed) {
  // [4 1 0; 1 -3 -1; 0 -1 2] and a matrix of zeros
  BandedLdlt factor(std::vector<int>{0, 1, 3, 5}, std::vector<int>{0, 0, 1, 1, 2});
  EXPECT_EQ(factor.factorize(std::vector<double>{4, 1, -3, -1, 2}), Factorization::indefinite);
  std::vector<double> x(3);
  factor.solve(std::vector<double>{6, -8, 4}, x);  // of (1, 2, 3)
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(x[i], i + 1, 1e-15);
  EXPECT_EQ(factor.factorize(std::vector<double>(5)), Factorization::failed);
}

TEST(BandedLdlt, BandwidthIsThatOfTheWidestRow) {
  EXPECT_EQ(BandedLdlt::bandwidth(std::vector<int>{0, 1, 2, 4}, std::vector<int>{0, 1, 0, 2}), 2);
  EXPECT_EQ(BandedLdlt::bandwidth(std::vector<int>{0, 1}, std::vector<int>{0}), 0);
}

}  // namespace
}  // namespace myowave::solver
