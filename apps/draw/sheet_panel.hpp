// One sheet of a figure. Lengths are points, places are from the upper left corner of the panel.
#pragma once

#include "apps/draw/canvas.hpp"
#include "apps/draw/plot.hpp"

namespace myowave::apps {

// The part of the plane that a sheet covers, length units.
struct SheetExtent {
  double low_1 = 0, low_2 = 0, high_1 = 0, high_2 = 0;
};

SheetExtent sheet_extent(const SheetPicture&);
SheetExtent joined(const SheetExtent&, const SheetExtent&);

class SheetPanel {
 public:
  // All sheets of one size in a figure show the same part of the plane.
  SheetPanel(const SheetPicture&, const SheetExtent&, double width, double top);

  double height() const;
  const Box& box() const { return box_; }
  void draw(Canvas&) const;

 private:
  void draw_colour_bar(Canvas&) const;

  const SheetPicture& sheet_;
  SheetExtent extent_;
  Box box_;
};

}  // namespace myowave::apps
