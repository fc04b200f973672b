// Numbers of runs in words: units, means with their spread, tests, and comparisons with a published number.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/draw/picture.hpp"
#include "apps/draw/plot.hpp"
#include "apps/results/run_results.hpp"
#include "solver/analysis/statistics.hpp"

namespace myowave::apps {

// One number of the paper beside ours.
struct Comparison {
  std::string what;
  std::string paper;  // or of an independent program; empty where neither gives it
  std::string ours{};
  std::string difference{};  // in words or per cent; empty where there is nothing to compare with
  std::string samples{};     // what the number is a mean of
  std::string why{};         // of a difference: the experiment that shows its cause
};

// 1 t.u. of the paper's rescaled time: a spiral turns in 26.9 t.u., 269 ms.
inline constexpr double ms_per_tu = 10;
inline constexpr double to_seconds(double tu) { return tu * ms_per_tu / 1000; }

std::vector<double> in_seconds(std::vector<double> tu);
std::vector<double> in_ms(std::vector<double> tu);

// "26.85 +- 0.37"; one value: "26.85"; none: "-".
std::string text_of(const solver::MeanSd&, int decimals);
// "n = 144".
std::string count_text(const solver::MeanSd&);
// "+1.2 %" of the paper's number.
std::string relative_difference(double ours, double papers);
// What is said of a statement of the paper that holds here too, or does not.
std::string verdict(bool holds);

// A row of periods (ms) beside the paper's mean.
Comparison period_row(std::string what, std::string paper, std::span<const double> periods_ms,
                      double papers_mean);
// A row of the difference of two series, a - b: the unpaired t-test that the paper uses, and one that knows
// how many independent samples a series in the order of time has.
Comparison test_row(std::string what, std::string paper, std::span<const double> a,
                    std::span<const double> b);

SheetPicture sheet_picture(const StoredFrame&, std::string title, SheetPicture::Shading);

}  // namespace myowave::apps
