#include "tests/support/allclose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <vector>

namespace myowave::testing_support {

::testing::AssertionResult all_close(std::span<const double> actual, std::span<const double> expected,
                                     int columns, Tolerance tolerance, int entries_listed) {
  if (actual.size() != expected.size())
    return ::testing::AssertionFailure()
           << fmt::format("{} entries where {} are expected", actual.size(), expected.size());

  struct Entry {
    std::size_t index;
    double excess;  // |difference| / allowed
    double difference;
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<Entry> failed;
  for (std::size_t k = 0; k < actual.size(); ++k) {
    if (actual[k] == expected[k]) continue;
    double difference = std::abs(actual[k] - expected[k]);
    if (!std::isfinite(difference)) difference = infinity;
    const double allowed = tolerance.absolute + tolerance.relative * std::abs(expected[k]);
    if (difference < infinity && difference <= allowed) continue;
    failed.push_back({k, difference < infinity ? difference / allowed : infinity, difference});
  }
  if (failed.empty()) return ::testing::AssertionSuccess();

  // Against a zero tolerance every excess is infinite: there the difference decides.
  std::sort(failed.begin(), failed.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(-a.excess, -a.difference, a.index) < std::tuple(-b.excess, -b.difference, b.index);
  });
  auto result = ::testing::AssertionFailure() << fmt::format(
                    "{} of {} entries differ by more than {} + {} |expected|; the worst:", failed.size(),
                    actual.size(), tolerance.absolute, tolerance.relative);
  const std::size_t listed = std::min(failed.size(), static_cast<std::size_t>(std::max(entries_listed, 1)));
  for (std::size_t n = 0; n < listed; ++n) {
    const std::size_t k = failed[n].index;
    const auto width = static_cast<std::size_t>(columns);
    result << fmt::format("\n  ({}, {}): {:.17g}, expected {:.17g}, difference {:.3e}", k / width, k % width,
                          actual[k], expected[k], actual[k] - expected[k]);
  }
  return result;
}

}  // namespace myowave::testing_support
