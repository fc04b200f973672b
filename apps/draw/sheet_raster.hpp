// V in colours on the deformed sheet, with the element lines, in the pixels of a picture.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "apps/draw/frame_shape.hpp"
#include "apps/draw/picture.hpp"
#include "apps/draw/strokes.hpp"

namespace myowave::apps {

// Where the plane of the sheet is in a picture: X1 points right, X2 up.
struct SheetView {
  double x = 0, y = 0;  // a point of the plane, length units
  Point pixel{};        // where it is
  double scale = 1;     // pixels a length unit

  Point to_pixel(double x1, double x2) const {
    return {pixel.x + scale * (x1 - x), pixel.y - scale * (x2 - y)};
  }
};

struct Sheet {
  FrameShape shape;
  std::span<const double> V;      // rows * columns
  std::span<const double> nodes;  // as in solver::Frame; not read of a rigid sheet
};

// V between the grid nodes, which are at whole rows and columns.
double sheet_V(const Sheet&, double row, double column);

// The corners of a rigid sheet, which is drawn as one element: {x1, x2} of (0, 0), (0, 1), (1, 0), (1, 1).
std::array<double, 8> sheet_corners(const FrameShape&);

// Fills the elements with `colour` of V and draws their lines, `line_width` pixels wide and lighter on dark
// ground; the lines around the sheet go to `border`.
void draw_sheet(Picture&, Strokes& border, const Sheet&, const SheetView&,
                const std::function<Colour(double)>& colour, double line_width = 1);

}  // namespace myowave::apps
