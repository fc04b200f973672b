#include "apps/draw/plot_panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace myowave::apps {
namespace {

constexpr double right_margin = 14, bottom_margin = 37;
constexpr double flat = 0.68;    // height of the axes over their width
constexpr double tallest = 1.2;  // the same, of equal scales
constexpr double tick_length = 3.5;
constexpr double margin_of_data = 0.04;  // of the range, so that data do not lie on the axes
constexpr double legend_line = 13, legend_sample = 18, legend_gap = 5;
constexpr Colour ink{30, 30, 30}, grey{150, 150, 150};
constexpr Pen axis_pen{ink, 0.7};
constexpr TextStyle number_style{.size = 8.5}, label_style{.size = 9.5}, legend_style{.size = 8.5};

// No line goes from one to the next.
bool stands_alone(Mark mark) { return mark == Mark::points || mark == Mark::rings; }
bool has_points(Mark mark) { return stands_alone(mark) || mark == Mark::linked_points; }

void draw_point(Canvas& canvas, Mark mark, Point at, Colour colour) {
  constexpr double radius = 1.9;
  if (mark == Mark::rings)
    canvas.ring(at, radius, {.colour = colour, .width = 0.8});
  else
    canvas.disc(at, radius, colour);
}

// Curves over time go from one end of the axis to the other.
bool fills_its_width(const Plot& plot) {
  return !plot.equal_scales && std::ranges::all_of(plot.series, [](const Series& series) {
    return series.mark == Mark::line || series.mark == Mark::steps;
  });
}

double smallest_step(std::vector<double> values) {
  std::ranges::sort(values);
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < values.size(); ++n)
    if (values[n] > values[n - 1]) step = std::min(step, values[n] - values[n - 1]);
  return std::isfinite(step) ? step : 1;
}

std::vector<double> all_x(const Plot& plot) {
  std::vector<double> values;
  for (const Series& series : plot.series) {
    const double half = series.mark == Mark::bars ? 0.5 * smallest_step(series.x) : 0;
    for (const double x : series.x)
      values.insert(values.end(), {place_on(plot.x, x - half), place_on(plot.x, x + half)});
  }
  return values;
}

std::vector<double> all_y(const Plot& plot) {
  std::vector<double> values;
  for (const double guide : plot.guides) values.push_back(place_on(plot.y, guide));
  for (const Series& series : plot.series) {
    for (std::size_t n = 0; n < series.y.size(); ++n) {
      const double half = n < series.error.size() && std::isfinite(series.error[n]) ? series.error[n] : 0;
      values.insert(values.end(),
                    {place_on(plot.y, series.y[n] - half), place_on(plot.y, series.y[n] + half)});
    }
  }
  return values;
}

// Bars stand on the axis.
AxisRange y_range(const Plot& plot) {
  const auto values = all_y(plot);
  AxisRange range = axis_range(plot.y, values, margin_of_data);
  const bool bars =
      std::ranges::any_of(plot.series, [](const Series& series) { return series.mark == Mark::bars; });
  if (bars && !plot.y.min && std::ranges::none_of(values, [](double y) { return y < 0; })) range.low = 0;
  return range;
}

// Leaves out points that nobody sees: nearer than a fifth of a point to the last one.
void add(std::vector<Point>& line, Point p) {
  constexpr double unseen = 0.2;
  if (line.size() > 1 && std::hypot(p.x - line.back().x, p.y - line.back().y) < unseen &&
      std::hypot(p.x - line[line.size() - 2].x, p.y - line[line.size() - 2].y) < unseen) {
    line.back() = p;
  } else {
    line.push_back(p);
  }
}

Ticks ticks_of(const Axis& axis, const AxisRange& range, int most) {
  return axis.logarithmic ? decade_ticks(range, most) : round_ticks(range, most);
}

Box grown(const Box& box, double by) {
  return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by};
}

}  // namespace

PlotPanel::PlotPanel(const Plot& plot, double width, double top)
    : plot_(plot),
      width_(width),
      top_(top),
      x_(axis_range(plot.x, all_x(plot), fills_its_width(plot) ? 0 : margin_of_data)),
      y_(y_range(plot)) {
  y_ticks_ = ticks_of(plot.y, y_, 6);
}

double PlotPanel::left_margin() const {
  double widest = 0;
  for (const auto& label : y_ticks_.labels) widest = std::max(widest, text_width(label, number_style));
  return 10 + label_style.size + 6 + widest + tick_length + 3;
}

double PlotPanel::lay_out(double left) {
  box_ = {left, top_, width_ - left - right_margin, 0};
  box_.height = flat * box_.width;
  if (plot_.equal_scales) {
    const double ratio = y_.length() / x_.length();
    const double room = box_.width;
    box_.height = std::min(ratio, tallest) * room;
    box_.width = box_.height / ratio;
    box_.x += 0.5 * (room - box_.width);
  }
  x_ticks_ = ticks_of(plot_.x, x_, std::max(2, static_cast<int>(box_.width / 42)));
  y_ticks_ = ticks_of(plot_.y, y_, std::max(2, static_cast<int>(box_.height / 28)));
  place_legend();
  return box_.bottom() + bottom_margin;
}

Point PlotPanel::to_point(double x, double y) const {
  return {box_.x + box_.width * (place_on(plot_.x, x) - x_.low) / x_.length(),
          box_.bottom() - box_.height * (place_on(plot_.y, y) - y_.low) / y_.length()};
}

std::vector<PlotPanel::Line> PlotPanel::pieces(const Series& series) const {
  std::vector<Line> lines(1);
  for (std::size_t n = 0; n < std::min(series.x.size(), series.y.size()); ++n) {
    if (!std::isfinite(place_on(plot_.x, series.x[n])) || !std::isfinite(place_on(plot_.y, series.y[n]))) {
      if (!lines.back().empty()) lines.emplace_back();
      continue;
    }
    const Point p = to_point(series.x[n], series.y[n]);
    if (series.mark == Mark::steps && !lines.back().empty()) add(lines.back(), {p.x, lines.back().back().y});
    add(lines.back(), p);
  }
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

double PlotPanel::bar_width(const Series& series) const {
  return box_.width * smallest_step(series.x) / x_.length();
}

Box PlotPanel::bar(const Series& series, std::size_t n) const {
  const Point top = to_point(series.x[n], series.y[n]), foot = to_point(series.x[n], 0);
  const double width = bar_width(series);
  return {top.x - 0.5 * width, std::min(top.y, foot.y), width, std::abs(foot.y - top.y)};
}

bool PlotPanel::hides_data(const Box& legend) const {
  const Box near = grown(legend, 4);
  for (const Series& series : plot_.series) {
    for (std::size_t n = 0; series.mark == Mark::bars && n < series.x.size(); ++n) {
      const Box one = bar(series, n);
      if (one.x < near.right() && near.x < one.right() && one.y < near.bottom() && near.y < one.bottom())
        return true;
    }
    for (const Line& line : pieces(series)) {
      Point last = line.front();
      for (const Point& p : line) {
        const bool linked = !stands_alone(series.mark);
        const int parts = linked ? 1 + static_cast<int>(std::hypot(p.x - last.x, p.y - last.y) / 3) : 1;
        for (int part = 1; part <= parts; ++part) {
          const double along = double(part) / parts;
          if (near.contains({last.x + along * (p.x - last.x), last.y + along * (p.y - last.y)})) return true;
        }
        last = p;
      }
    }
    for (std::size_t n = 0; n < std::min(series.error.size(), series.y.size()); ++n) {
      for (int part = -4; part <= 4; ++part)
        if (near.contains(to_point(series.x[n], series.y[n] + 0.25 * part * series.error[n]))) return true;
    }
  }
  return false;
}

// In the first place of the axes that is free of data, else above them.
void PlotPanel::place_legend() {
  legend_.clear();
  double widest = 0;
  for (std::size_t n = 0; n < plot_.series.size(); ++n) {
    if (plot_.series[n].name.empty()) continue;
    legend_.push_back({n, {}});
    widest = std::max(widest, text_width(plot_.series[n].name, legend_style));
  }
  if (legend_.empty()) return;
  const double width = legend_sample + legend_gap + widest, height = legend_line * double(legend_.size());
  constexpr double inset = 7;
  const double l = box_.x + inset, r = box_.right() - inset - width, t = box_.y + inset;
  const double b = box_.bottom() - inset - height, m = 0.5 * (l + r), c = 0.5 * (t + b);
  for (const Point& corner :
       std::array<Point, 8>{{{r, t}, {l, t}, {r, b}, {l, b}, {m, t}, {m, b}, {r, c}, {l, c}}}) {
    const Box place{corner.x, corner.y, width, height};
    if (width > box_.width - 2 * inset || height > box_.height - 2 * inset || hides_data(place)) continue;
    for (std::size_t n = 0; n < legend_.size(); ++n)
      legend_[n].at = {corner.x, corner.y + legend_line * (double(n) + 0.5)};
    return;
  }
  legend_above(width + 14, legend_.size());
}

void PlotPanel::legend_above(double entry_width, std::size_t entries) {
  const double room = width_ - box_.x - right_margin;
  const auto across = std::clamp<std::size_t>(static_cast<std::size_t>(room / entry_width), 1, entries);
  const auto lines = (entries + across - 1) / across;
  for (std::size_t n = 0; n < entries; ++n) {
    legend_[n].at = {box_.x + entry_width * double(n % across),
                     box_.y + legend_line * (double(n / across) + 0.3)};
  }
  box_.y += legend_line * double(lines) + 2;
}

void PlotPanel::draw_axes(Canvas& canvas) const {
  for (const double guide : plot_.guides) {
    const double y = to_point(x_.low, guide).y;
    if (y < box_.y || y > box_.bottom()) continue;
    canvas.line(std::array<Point, 2>{{{box_.x, y}, {box_.right(), y}}},
                {.colour = grey, .width = 0.7, .dashed = true});
  }
  canvas.frame(box_, axis_pen);
  for (std::size_t n = 0; n < x_ticks_.values.size(); ++n) {
    const double x = to_point(x_ticks_.values[n], y_.low).x;
    canvas.line(std::array<Point, 2>{{{x, box_.bottom()}, {x, box_.bottom() + tick_length}}}, axis_pen);
    TextStyle style = number_style;
    style.align = 0.5;
    canvas.text({x, box_.bottom() + tick_length + 10}, x_ticks_.labels[n], style);
  }
  double widest = 0;
  for (std::size_t n = 0; n < y_ticks_.values.size(); ++n) {
    const double y = to_point(x_.low, y_ticks_.values[n]).y;
    canvas.line(std::array<Point, 2>{{{box_.x - tick_length, y}, {box_.x, y}}}, axis_pen);
    TextStyle style = number_style;
    style.align = 1;
    canvas.text({box_.x - tick_length - 3, y + 3.1}, y_ticks_.labels[n], style);
    widest = std::max(widest, text_width(y_ticks_.labels[n], style));
  }
  TextStyle style = label_style;
  style.align = 0.5;
  canvas.text({box_.x + 0.5 * box_.width, box_.bottom() + 30}, axis_text(plot_.x, x_ticks_.exponent), style);
  style.upwards = true;
  canvas.text({box_.x - tick_length - 3 - widest - 7, box_.y + 0.5 * box_.height},
              axis_text(plot_.y, y_ticks_.exponent), style);
}

void PlotPanel::draw_marks(Canvas& canvas, std::size_t n) const {
  const Series& series = plot_.series[n];
  const Colour colour = series_colour(series, n);
  if (series.mark == Mark::bars) {
    for (std::size_t k = 0; k < std::min(series.x.size(), series.y.size()); ++k) {
      if (!std::isfinite(series.y[k]) || series.y[k] == 0) continue;
      canvas.rectangle(bar(series, k), colour, 0.5);
      canvas.frame(bar(series, k), {.colour = colour, .width = 0.6});
    }
  }
  const bool line = !stands_alone(series.mark) && series.mark != Mark::bars;
  const bool points = has_points(series.mark);
  for (std::size_t k = 0; k < std::min(series.error.size(), series.y.size()); ++k) {
    if (!std::isfinite(series.y[k]) || !(series.error[k] > 0)) continue;
    const Point low = to_point(series.x[k], series.y[k] - series.error[k]);
    const Point high = to_point(series.x[k], series.y[k] + series.error[k]);
    for (const auto& [from, to] :
         std::array<std::pair<Point, Point>, 3>{{{low, high},
                                                 {{low.x - 2.5, low.y}, {low.x + 2.5, low.y}},
                                                 {{high.x - 2.5, high.y}, {high.x + 2.5, high.y}}}})
      canvas.line(std::array<Point, 2>{from, to}, {.colour = colour, .width = 0.8});
  }
  for (const Line& piece : pieces(series)) {
    if (line) canvas.line(piece, {.colour = colour, .width = points ? 0.9 : 1.2, .dashed = series.dashed});
    // A line of one point would not be seen.
    if (points || (line && piece.size() == 1))
      for (const Point& p : piece) draw_point(canvas, series.mark, p, colour);
  }
}

void PlotPanel::draw_legend(Canvas& canvas) const {
  for (const Entry& entry : legend_) {
    const Series& series = plot_.series[entry.series];
    const Colour colour = series_colour(series, entry.series);
    const Point end{entry.at.x + legend_sample, entry.at.y};
    if (series.mark == Mark::bars) {
      const Box sample{entry.at.x + 3, entry.at.y - 4, legend_sample - 6, 8};
      canvas.rectangle(sample, colour, 0.5);
      canvas.frame(sample, {.colour = colour, .width = 0.6});
    } else if (!stands_alone(series.mark)) {
      canvas.line(std::array<Point, 2>{entry.at, end},
                  {.colour = colour, .width = 1.2, .dashed = series.dashed});
    }
    if (has_points(series.mark))
      draw_point(canvas, series.mark, {entry.at.x + 0.5 * legend_sample, entry.at.y}, colour);
    canvas.text({end.x + legend_gap, end.y + 3.1}, series.name, legend_style);
  }
}

void PlotPanel::draw(Canvas& canvas) const {
  canvas.enter_clip(grown(box_, 2));
  for (std::size_t n = 0; n < plot_.series.size(); ++n) draw_marks(canvas, n);
  canvas.leave();
  draw_axes(canvas);
  draw_legend(canvas);
}

}  // namespace myowave::apps
