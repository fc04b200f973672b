#include "apps/report/difference_text.hpp"

#include <fmt/format.h>

#include "solver/analysis/statistics.hpp"

namespace myowave::apps {

DifferenceText difference_text(std::span<const double> a, std::span<const double> b) {
  const auto of_a = solver::series_statistics(a), of_b = solver::series_statistics(b);
  const auto student = solver::student_t_test(of_a, of_b);
  const auto welch = solver::welch_t_test(of_a, of_b);
  const auto p = [](const auto& test) {
    if (!test) return std::string("no test");
    constexpr double smallest = 1e-12;  // below it the p value of the normal tail has no meaning
    return test->p < smallest ? fmt::format("p < {:.0g}", smallest) : fmt::format("p = {:.2g}", test->p);
  };
  return {.difference = fmt::format("difference {:+.2f}; unpaired t-test {}; with the correlation {}",
                                    of_a.mean - of_b.mean, p(student), p(welch)),
          .samples = fmt::format("n = {} and {}, of them independent {:.0f} and {:.0f}", of_a.n, of_b.n,
                                 of_a.effective_n, of_b.effective_n)};
}

}  // namespace myowave::apps
