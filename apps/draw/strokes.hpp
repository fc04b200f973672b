// Lines and text over a picture.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "apps/draw/picture.hpp"
#include "apps/draw/text_style.hpp"

namespace myowave::apps {

// How much of each pixel of a picture lines and letters cover. Lines that cross do not add up, so that a net
// of half-transparent lines has no spots at its knots. Lengths in pixels.
class Strokes {
 public:
  // Errors: std::runtime_error with cairo's reason.
  explicit Strokes(const Picture&);
  ~Strokes();

  void line(std::span<const Point>, double width);
  // The point is on the base line; a style's colour is not used.
  void text(Point, std::string_view, const TextStyle&);

  void paint(Picture&, Colour, double opacity);
  // Darkens light ground and lightens dark ground.
  void paint_contrast(Picture&, double opacity);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace myowave::apps
