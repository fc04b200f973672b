// Compares two arrays entry by entry and, where they differ, prints the worst entries with their
// place: EXPECT_TRUE(all_close(actual, expected, columns, {.absolute = 1e-12})).
#pragma once

#include <gtest/gtest.h>

#include <span>

namespace myowave::testing_support {

// An entry passes when |actual - expected| <= absolute + relative |expected|. A value that is not
// finite passes only against the same value, never NaN.
struct Tolerance {
  double absolute = 0;
  double relative = 0;
};

// Entry k is reported as row k / columns, column k % columns.
::testing::AssertionResult all_close(std::span<const double> actual, std::span<const double> expected,
                                     int columns, Tolerance tolerance, int entries_listed = 5);

}  // namespace myowave::testing_support
