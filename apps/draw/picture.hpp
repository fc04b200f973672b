// A picture in memory.
#pragma once

#include <cstddef>
#include <string>
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

}  // namespace myowave::apps
