#include "apps/report/comparison.hpp"

#include <fmt/format.h>

namespace myowave::apps {

std::vector<double> in_seconds(std::vector<double> tu) {
  for (double& t : tu) t = to_seconds(t);
  return tu;
}

std::vector<double> in_ms(std::vector<double> tu) {
  for (double& t : tu) t *= ms_per_tu;
  return tu;
}

std::string text_of(const solver::MeanSd& value, int decimals) {
  if (value.n == 0) return "-";
  if (value.n == 1) return fmt::format("{:.{}f}", value.mean, decimals);
  return fmt::format("{:.{}f} +- {:.{}f}", value.mean, decimals, value.sd, decimals);
}

std::string count_text(const solver::MeanSd& value) { return fmt::format("n = {}", value.n); }

std::string relative_difference(double ours, double papers) {
  return fmt::format("{:+.1f} %", 100 * (ours / papers - 1));
}

std::string verdict(bool holds) { return holds ? "agrees" : "differs"; }

Comparison period_row(std::string what, std::string paper, std::span<const double> periods_ms,
                      double papers_mean) {
  const auto ours = solver::mean_sd(periods_ms);
  return {.what = std::move(what),
          .paper = std::move(paper),
          .ours = fmt::format("{} ms", text_of(ours, 1)),
          .difference = relative_difference(ours.mean, papers_mean),
          .samples = count_text(ours)};
}

Comparison test_row(std::string what, std::string paper, std::span<const double> a,
                    std::span<const double> b) {
  const auto of_a = solver::series_statistics(a), of_b = solver::series_statistics(b);
  const auto student = solver::student_t_test(of_a, of_b);
  const auto welch = solver::welch_t_test(of_a, of_b);
  const auto p = [](const auto& test) {
    if (!test) return std::string("no test");
    constexpr double smallest = 1e-12;  // below it the normal tail is not what the samples tell of
    return test->p < smallest ? fmt::format("p < {:.0g}", smallest) : fmt::format("p = {:.2g}", test->p);
  };
  return {.what = std::move(what),
          .paper = std::move(paper),
          .ours = fmt::format("difference {:+.2f}; unpaired t-test {}; with the correlation {}",
                              of_a.mean - of_b.mean, p(student), p(welch)),
          .samples = fmt::format("n = {} and {}, of them independent {:.0f} and {:.0f}", of_a.n, of_b.n,
                                 of_a.effective_n, of_b.effective_n)};
}

SheetPicture sheet_picture(const StoredFrame& frame, std::string title, SheetPicture::Shading shading) {
  return {.title = std::move(title),
          .shape = frame.shape,
          .V = frame.V,
          .nodes = frame.nodes,
          .shading = shading};
}

}  // namespace myowave::apps
