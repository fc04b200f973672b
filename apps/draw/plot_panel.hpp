// One plot of a figure. Lengths are points, places are from the upper left corner of the panel.
#pragma once

#include <vector>

#include "apps/draw/canvas.hpp"
#include "apps/draw/plot_axes.hpp"

namespace myowave::apps {

class PlotPanel {
 public:
  // `width`: of the whole panel. `top`: what stands above the plot needs.
  PlotPanel(const Plot&, double width, double top);

  // What its labels on the left need.
  double left_margin() const;
  // Gives the axes their place, `left` from the left. Returns the height of the panel.
  double lay_out(double left);
  // Where the axes are.
  const Box& box() const { return box_; }
  void draw(Canvas&) const;

 private:
  struct Entry {
    std::size_t series;
    Point at;  // left end of its sample
  };
  using Line = std::vector<Point>;

  Point to_point(double x, double y) const;
  // Without gaps, in steps where it is drawn so.
  std::vector<Line> pieces(const Series&) const;
  double bar_width(const Series&) const;
  Box bar(const Series&, std::size_t n) const;
  bool hides_data(const Box&) const;
  void place_legend();
  void legend_above(double entry_width, std::size_t entries);
  void draw_axes(Canvas&) const;
  void draw_marks(Canvas&, std::size_t n) const;
  void draw_legend(Canvas&) const;

  const Plot& plot_;
  double width_, top_;
  AxisRange x_, y_;
  Ticks x_ticks_, y_ticks_;
  Box box_;
  std::vector<Entry> legend_;
};

}  // namespace myowave::apps
