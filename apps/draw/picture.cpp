#include "apps/draw/picture.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace myowave::apps {
namespace {

// A glyph of strokes: points "xy" in hexadecimal, a comma between two strokes. The base line is
// y = 0, capitals and digits reach y = 10.
struct Glyph {
  char character;
  double width;
  std::string_view strokes;
};

constexpr double capital_height = 10;
constexpr double spacing = 2.6;

constexpr Glyph glyphs[] = {
    {' ', 2, ""},
    {'.', 1, "00 10 11 01 00"},
    {'-', 6, "04 64"},
    {'=', 6, "03 63,06 66"},
    {'0', 6, "20 11 03 07 19 2A 4A 59 67 63 51 40 20"},
    {'1', 4, "08 2A 20,00 40"},
    {'2', 6, "08 19 2A 4A 59 68 66 00 60"},
    {'3', 6, "08 19 2A 4A 59 68 67 55 64 62 51 40 20 11 02,25 55"},
    {'4', 6, "4A 03 63,47 40"},
    {'5', 6, "5A 0A 05 26 46 55 64 62 51 40 20 11 02"},
    {'6', 6, "59 4A 2A 19 07 03 11 20 40 51 63 64 55 46 26 15 04"},
    {'7', 6, "0A 6A 20"},
    {'8', 6, "25 16 07 08 19 2A 4A 59 68 67 56 45 25 14 03 02 11 20 40 51 62 63 54 45"},
    {'9', 6, "11 20 40 51 63 67 59 4A 2A 19 07 06 15 24 44 55 66"},
    {'V', 6, "0A 30 6A"},
    {'m', 8, "07 00,05 16 27 37 46 40,45 56 67 77 86 80"},
    {'s', 5, "56 47 17 06 05 14 34 53 51 40 10 01"},
    {'t', 4, "1A 11 20 40,07 47"},
};

const Glyph& glyph_of(char character) {
  const auto* found = std::find_if(std::begin(glyphs), std::end(glyphs),
                                   [=](const Glyph& glyph) { return glyph.character == character; });
  if (found == std::end(glyphs)) throw std::logic_error(std::string("no glyph for '") + character + "'");
  return *found;
}

double digit(char c) { return c <= '9' ? c - '0' : c - 'A' + 10; }

std::uint8_t mix(std::uint8_t from, std::uint8_t to, double part) {
  return static_cast<std::uint8_t>(std::lround(from + part * (to - from)));
}

Colour mix(const Colour& from, const Colour& to, double part) {
  return {mix(from.red, to.red, part), mix(from.green, to.green, part), mix(from.blue, to.blue, part)};
}

}  // namespace

Picture::Picture(int width, int height, Colour background)
    : width_(width), height_(height), pixels_(std::size_t(width) * std::size_t(height), background) {}

std::string Picture::png() const {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(width_);
  image.height = png_uint_32(height_);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels_.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("cannot encode a PNG: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

Strokes::Strokes(const Picture& picture)
    : width_(picture.width()),
      height_(picture.height()),
      coverage_(std::size_t(width_) * std::size_t(height_), 0) {}

void Strokes::line(Point from, Point to, double width) {
  const double reach = 0.5 * width + 0.5;
  const auto [low_x, high_x] = std::minmax(from.x, to.x);
  const auto [low_y, high_y] = std::minmax(from.y, to.y);
  const int first_x = std::max(0, int(std::floor(low_x - reach)));
  const int last_x = std::min(width_ - 1, int(std::ceil(high_x + reach)));
  const int first_y = std::max(0, int(std::floor(low_y - reach)));
  const int last_y = std::min(height_ - 1, int(std::ceil(high_y + reach)));
  const Point along{to.x - from.x, to.y - from.y};
  const double length2 = along.x * along.x + along.y * along.y;
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const Point d{x - from.x, y - from.y};
      const double part = length2 > 0 ? std::clamp((d.x * along.x + d.y * along.y) / length2, 0.0, 1.0) : 0.0;
      const Point off{d.x - part * along.x, d.y - part * along.y};
      const double distance = std::sqrt(off.x * off.x + off.y * off.y);
      auto& covered = coverage_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
      covered = std::max(
          covered, static_cast<std::uint8_t>(std::lround(255 * std::clamp(reach - distance, 0.0, 1.0))));
    }
  }
}

double Strokes::text(Point at, double height, std::string_view characters) {
  const double scale = height / capital_height;
  for (const char character : characters) {
    const auto& [_, width, strokes] = glyph_of(character);
    for (std::size_t n = 3; n + 2 <= strokes.size(); n += 3) {
      if (strokes[n - 1] == ',') continue;
      const auto point = [&](std::size_t k) -> Point {
        return {at.x + scale * digit(strokes[k]), at.y - scale * digit(strokes[k + 1])};
      };
      line(point(n - 3), point(n), std::max(1.0, 0.12 * height));
    }
    at.x += scale * (width + spacing);
  }
  return at.x;
}

double text_width(double height, std::string_view characters) {
  double width = 0;
  for (const char character : characters) width += glyph_of(character).width + spacing;
  return width * height / capital_height;
}

void Strokes::paint(Picture& picture, Colour colour, double opacity) const {
  for (std::size_t n = 0; n < coverage_.size(); ++n) {
    if (coverage_[n] == 0) continue;
    auto& pixel = picture.at(int(n) % width_, int(n) / width_);
    pixel = mix(pixel, colour, opacity / 255 * coverage_[n]);
  }
}

void Strokes::paint_contrast(Picture& picture, double opacity) const {
  // Half way between black and white for the eye (CIELAB L* = 50).
  constexpr double middle = 0.184;
  for (std::size_t n = 0; n < coverage_.size(); ++n) {
    if (coverage_[n] == 0) continue;
    auto& pixel = picture.at(int(n) % width_, int(n) / width_);
    const Colour ink = luminance(pixel) > middle ? Colour{0, 0, 0} : Colour{255, 255, 255};
    pixel = mix(pixel, ink, opacity / 255 * coverage_[n]);
  }
}

}  // namespace myowave::apps
