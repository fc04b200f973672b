// The numbers of an axis: its range, its ticks and how they are written.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/draw/plot.hpp"

namespace myowave::apps {

struct AxisRange {
  double low = 0, high = 1;

  double length() const { return high - low; }
};

// Where a value stands on its axis: its decimal logarithm on a logarithmic one, nan where it has none.
double place_on(const Axis&, double value);

// In places. From the axis where it gives them, else what the places in `values` span, with `margin` of its
// length on both sides; never empty. Values that are not finite do not count.
AxisRange axis_range(const Axis&, std::span<const double> values, double margin);

struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
  int exponent = 0;  // the labels are in units of 10^exponent
};

// Multiples of 1, 2 or 5 times a power of ten in the range; at most `most` of them, and at least two where
// `most` > 2.
Ticks round_ticks(const AxisRange&, int most);

// Of a logarithmic axis, whose range is in places: whole powers of ten, and 2 and 5 times these where there
// are fewer than three.
Ticks decade_ticks(const AxisRange&, int most);

// "time (s)", "cells (10³)", "rate (10³ 1/s)".
std::string axis_text(const Axis&, int exponent);

}  // namespace myowave::apps
