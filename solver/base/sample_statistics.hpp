// Results of statistics: moments of samples and of series, quartiles.
#pragma once

#include <cstdint>
#include <optional>

namespace myowave::solver {

struct MeanSd {
  double mean = 0, sd = 0;  // sd: of the sample, over n - 1
  std::int64_t n = 0;
};

// Of samples at equal intervals that need not be independent.
struct SeriesStatistics : MeanSd {
  // Integrated correlation time in sampling intervals: 1 for independent samples. None if all are equal.
  std::optional<double> correlation;
  double effective_n = 0;     // n / correlation, at most n
  double standard_error = 0;  // of the mean: sd / sqrt(effective_n)
};

// Of the finite values.
struct Quartiles {
  double lower = 0, median = 0, upper = 0;
  std::int64_t n = 0;
};

}  // namespace myowave::solver
