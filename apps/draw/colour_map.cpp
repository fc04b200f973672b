#include "apps/draw/colour_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace myowave::apps {
namespace {

// sRGB at equal steps of lightness: L* = 97, 86.6, ... 14; hue angle 105, 125, 160, 195, 228, 255,
// 275, 288, 295 degrees; chroma at most 40 and inside the gamut.
constexpr std::array<Colour, 9> control_points{{{250, 247, 224},
                                                {205, 223, 179},
                                                {132, 203, 167},
                                                {67, 176, 174},
                                                {16, 145, 173},
                                                {9, 114, 161},
                                                {5, 84, 145},
                                                {30, 55, 113},
                                                {26, 32, 74}}};

std::array<Colour, 256> make_table() {
  std::array<Colour, 256> table;
  for (std::size_t n = 0; n < table.size(); ++n) {
    const double at = double(n) / (table.size() - 1) * (control_points.size() - 1);
    const auto low = std::min(std::size_t(at), control_points.size() - 2);
    const auto &from = control_points[low], &to = control_points[low + 1];
    const auto mix = [part = at - double(low)](std::uint8_t x, std::uint8_t y) {
      return static_cast<std::uint8_t>(std::lround(x + part * (y - x)));
    };
    table[n] = {mix(from.red, to.red), mix(from.green, to.green), mix(from.blue, to.blue)};
  }
  return table;
}

}  // namespace

Colour colour_of(double value) {
  static const auto table = make_table();
  return table[static_cast<std::size_t>(std::clamp(value, 0.0, 1.0) * (table.size() - 1) + 0.5)];
}

double luminance(const Colour& colour) {
  static const auto linear = [] {
    std::array<double, 256> table;
    for (std::size_t level = 0; level < table.size(); ++level) {
      const double c = double(level) / 255;
      table[level] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    return table;
  }();
  return 0.2126 * linear[colour.red] + 0.7152 * linear[colour.green] + 0.0722 * linear[colour.blue];
}

}  // namespace myowave::apps
