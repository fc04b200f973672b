// Lines, letters and images on a page that is a PNG or an SVG, drawn by cairo.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "apps/draw/picture.hpp"
#include "apps/draw/text_style.hpp"

namespace myowave::apps {

// Lengths in points of the page; x to the right, y down.
struct Box {
  double x = 0, y = 0, width = 0, height = 0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  bool contains(Point p) const { return p.x >= x && p.x <= right() && p.y >= y && p.y <= bottom(); }
};

struct Pen {
  Colour colour{};
  double width = 1;
  bool dashed = false;
  double opacity = 1;
};

class Canvas {
 public:
  enum class Format { png, svg };
  // Errors: std::runtime_error with cairo's reason, here and in content.
  Canvas(Format, double width, double height);
  ~Canvas();

  void line(std::span<const Point>, const Pen&);
  void rectangle(const Box&, Colour fill, double opacity = 1);
  void frame(const Box&, const Pen&);
  void disc(Point centre, double radius, Colour);
  void ring(Point centre, double radius, const Pen&);
  // The point is on the base line.
  void text(Point, std::string_view, const TextStyle&);
  void image(const Box&, const Picture&);
  // Until `leave`, the corner is the origin.
  void enter(Point corner);
  // Until `leave`, only what is in the box shows.
  void enter_clip(const Box&);
  void leave();

  // The whole file. Nothing can be drawn after.
  std::string content();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Pixels of a PNG a point.
inline constexpr double pixels_per_point = 1.5;

}  // namespace myowave::apps
