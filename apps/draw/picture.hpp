// A picture in memory: pixels, smooth lines and text in a font of strokes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "apps/draw/colour_map.hpp"

namespace myowave::apps {

// Pixel coordinates: x to the right, y down, the middle of the first pixel at (0, 0).
struct Point {
  double x = 0, y = 0;
};

class Picture {
 public:
  Picture(int width, int height, Colour background);

  int width() const { return width_; }
  int height() const { return height_; }
  Colour& at(int x, int y) { return pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }
  const Colour& at(int x, int y) const {
    return pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
  }

  // PNG, 8 bit RGB.
  std::string png() const;

 private:
  int width_, height_;
  std::vector<Colour> pixels_;
};

// How much of each pixel strokes cover. Strokes that meet do not add up, so that a net of
// half-transparent lines has no spots at its knots.
class Strokes {
 public:
  explicit Strokes(const Picture&);
  void line(Point from, Point to, double width);
  // Written to the right of `at`, the left end of its base line. Known: digits, space and .-=Vmst
  // Returns where it ends.
  double text(Point at, double height, std::string_view);

  void paint(Picture&, Colour, double opacity) const;
  // Darkens light ground and lightens dark ground.
  void paint_contrast(Picture&, double opacity) const;

 private:
  int width_, height_;
  std::vector<std::uint8_t> coverage_;  // 255: all of the pixel
};

// The width that Strokes::text takes.
double text_width(double height, std::string_view);

}  // namespace myowave::apps
