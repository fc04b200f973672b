// A frame as a picture: V in colours on the deformed sheet with the element lines (the paper's
// Fig 4), the time, and the bar of the colours. X1 points right, X2 up.
#pragma once

#include "apps/draw/frame_shape.hpp"
#include "apps/draw/picture.hpp"
#include "apps/draw/sheet_raster.hpp"
#include "solver/base/run_output.hpp"

namespace myowave::apps {

class FramePicture {
 public:
  // The view is the same for all frames of a run and holds the sheet at its largest.
  explicit FramePicture(const solver::Scene&);

  Picture draw(const solver::Frame&) const;
  // Where a point of the (deformed) sheet is in the picture.
  Point to_pixel(double x1, double x2) const { return view_.to_pixel(x1, x2); }

 private:
  void draw_labels(Picture&, Strokes& text, double t) const;

  FrameShape shape_;
  double ms_per_tu_;
  int decimals_;  // of the time, ms
  SheetView view_;
  int view_width_, view_height_;
};

}  // namespace myowave::apps
