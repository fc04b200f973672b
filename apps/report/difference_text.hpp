// Whether two series differ in their means, in words.
#pragma once

#include <span>
#include <string>

namespace myowave::apps {

struct DifferenceText {
  std::string difference, samples;
};

// Of a - b, in the order of time: the unpaired t-test that the paper uses, and Welch's with the number of
// independent samples that each series is worth.
DifferenceText difference_text(std::span<const double> a, std::span<const double> b);

}  // namespace myowave::apps
