#include "apps/draw/plot_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace myowave::apps {
namespace {

// The least of 1, 2 and 5 times a power of ten that is not below `step`.
double round_up(double step) {
  const double decade = std::pow(10, std::floor(std::log10(step)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= step * (1 - 1e-9)) return digit * decade;
  return 10 * decade;
}

std::string superscript(int exponent) {
  static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : fmt::format("{}", std::abs(exponent))) text += digits[digit - '0'];
  return text;
}

}  // namespace

double place_on(const Axis& axis, double value) {
  if (!axis.logarithmic) return value;
  return value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
}

AxisRange axis_range(const Axis& axis, std::span<const double> values, double margin) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) low = axis.min.value_or(axis.max.value_or(1) - 1), high = low + 1;
  // A constant is in the middle of something that can be seen.
  if (low == high) {
    const double half = low == 0 ? 1 : 0.1 * std::abs(low);
    low -= half, high += half;
  }
  const double space = margin * (high - low);
  AxisRange range{axis.min ? place_on(axis, *axis.min) : low - space,
                  axis.max ? place_on(axis, *axis.max) : high + space};
  if (!(range.low < range.high)) {
    (axis.min && !axis.max ? range.high : range.low) = axis.min && !axis.max ? range.low + 1 : range.high - 1;
  }
  return range;
}

Ticks round_ticks(const AxisRange& range, int most) {
  const double step = round_up(range.length() / std::max(1, most));
  Ticks ticks;
  const double edge = 1e-9 * range.length();
  for (double n = std::ceil((range.low - edge) / step); n * step <= range.high + edge; ++n)
    ticks.values.push_back(n * step + 0.0);  // never -0
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  const int magnitude = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
  if (magnitude >= 5 || magnitude < -3) ticks.exponent = 3 * static_cast<int>(std::floor(magnitude / 3.0));
  const double unit = std::pow(10, ticks.exponent);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step / unit) + 1e-9)));
  for (const double value : ticks.values) {
    const std::string digits = fmt::format("{:.{}f}", std::abs(value / unit), decimals);
    ticks.labels.push_back((value < 0 ? "−" : "") + digits);
  }
  return ticks;
}

Ticks decade_ticks(const AxisRange& range, int most) {
  const int first = static_cast<int>(std::floor(range.low)), last = static_cast<int>(std::ceil(range.high));
  const auto inside = [&](double value) {
    return std::log10(value) >= range.low - 1e-9 && std::log10(value) <= range.high + 1e-9;
  };
  Ticks ticks;
  const auto add = [&](int digit, int power) {
    const double value = digit * std::pow(10, power);
    if (!inside(value)) return;
    ticks.values.push_back(value);
    ticks.labels.push_back(power >= -3 && power <= 3 ? fmt::format("{:g}", value)
                           : digit == 1              ? "10" + superscript(power)
                                                     : fmt::format("{}·10{}", digit, superscript(power)));
  };
  const bool few = range.length() < 3;
  const int step = few ? 1 : std::max(1, static_cast<int>(std::ceil(range.length() / most)));
  for (int power = first; power <= last; power += step)
    for (const int digit : {1, 2, 5})
      if (digit == 1 || few) add(digit, power);
  return ticks;
}

std::string axis_text(const Axis& axis, int exponent) {
  std::string unit = exponent == 0 ? "" : "10" + superscript(exponent);
  if (!unit.empty() && !axis.unit.empty()) unit += ' ';
  unit += axis.unit;
  return unit.empty() ? axis.label : fmt::format("{} ({})", axis.label, unit);
}

}  // namespace myowave::apps
