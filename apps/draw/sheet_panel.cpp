#include "apps/draw/sheet_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "apps/draw/sheet_raster.hpp"

namespace myowave::apps {
namespace {

constexpr double side_margin = 12, bottom_margin = 12, colour_bar_space = 36;
constexpr double tallest = 1.4;  // height of a sheet over its width, else it gets narrower
// Of the picture of the sheet, so that it is sharp in print (300 dpi at 3.4 inches a panel).
constexpr double sheet_pixels_per_point = 3;
constexpr Colour white{255, 255, 255}, dark{70, 70, 70}, ink{30, 30, 30};

bool is_rigid(const SheetPicture& sheet) { return sheet.nodes.empty(); }

Sheet to_draw(const SheetPicture& sheet) {
  FrameShape shape = sheet.shape;
  if (is_rigid(sheet)) shape.cells = 0;
  if (sheet.V.size() != shape.grid_nodes() || sheet.nodes.size() != 2 * shape.element_nodes()) {
    throw std::invalid_argument("a sheet to draw does not have the V or the nodes of its shape");
  }
  return {shape, sheet.V, sheet.nodes};
}

}  // namespace

SheetExtent sheet_extent(const SheetPicture& sheet) {
  const double length_1 = (sheet.shape.columns - 1) * sheet.shape.dx;
  const double length_2 = (sheet.shape.rows - 1) * sheet.shape.dx;
  if (is_rigid(sheet)) return {0, 0, length_1, length_2};
  SheetExtent extent{sheet.nodes[0], sheet.nodes[1], sheet.nodes[0], sheet.nodes[1]};
  for (std::size_t n = 2; n < sheet.nodes.size(); n += 2)
    extent = joined(extent, {sheet.nodes[n], sheet.nodes[n + 1], sheet.nodes[n], sheet.nodes[n + 1]});
  return extent;
}

SheetExtent joined(const SheetExtent& a, const SheetExtent& b) {
  return {std::min(a.low_1, b.low_1), std::min(a.low_2, b.low_2), std::max(a.high_1, b.high_1),
          std::max(a.high_2, b.high_2)};
}

SheetPanel::SheetPanel(const SheetPicture& sheet, const SheetExtent& extent, double width, double top)
    : sheet_(sheet), extent_(extent) {
  const double bar = sheet.shading == SheetPicture::Shading::colours ? colour_bar_space : 0;
  const double room = width - 2 * side_margin - bar;
  const double ratio = (extent.high_2 - extent.low_2) / (extent.high_1 - extent.low_1);
  const double height = std::min(ratio, tallest) * room;
  box_ = {side_margin + 0.5 * (room - height / ratio), top, height / ratio, height};
}

double SheetPanel::height() const { return box_.bottom() + bottom_margin; }

void SheetPanel::draw(Canvas& canvas) const {
  constexpr double scale = sheet_pixels_per_point;
  constexpr double border = 2;  // points around, for the lines of the edges
  const Box framed{box_.x - border, box_.y - border, box_.width + 2 * border, box_.height + 2 * border};
  Picture picture(int(std::ceil(scale * framed.width)), int(std::ceil(scale * framed.height)), white);
  const SheetView view{.x = extent_.low_1,
                       .y = extent_.high_2,
                       .pixel = {scale * border, scale * border},
                       .scale = scale * box_.width / (extent_.high_1 - extent_.low_1)};
  Strokes edges(picture);
  const auto two_tones = [this](double V) { return V > sheet_.dark_above ? dark : white; };
  const bool colours = sheet_.shading == SheetPicture::Shading::colours;
  draw_sheet(picture, edges, to_draw(sheet_), view,
             colours ? colour_of : std::function<Colour(double)>(two_tones), 0.4 * scale);
  edges.paint(picture, ink, 1);
  canvas.image({framed.x, framed.y, picture.width() / scale, picture.height() / scale}, picture);
  for (std::size_t n = 0; n < sheet_.paths.size(); ++n) {
    const Series& path = sheet_.paths[n];
    std::vector<Point> points;
    const auto end = std::min(path.x.size(), path.y.size());
    for (std::size_t k = 0; k <= end; ++k) {
      if (k < end && std::isfinite(path.x[k]) && std::isfinite(path.y[k])) {
        const Point pixel = view.to_pixel(path.x[k], path.y[k]);
        points.push_back({framed.x + pixel.x / scale, framed.y + pixel.y / scale});
      } else {
        canvas.line(points, {.colour = series_colour(path, n), .width = 1.1, .dashed = path.dashed});
        points.clear();
      }
    }
  }
  if (colours) draw_colour_bar(canvas);
}

void SheetPanel::draw_colour_bar(Canvas& canvas) const {
  constexpr double width = 7, tick = 2.5;
  const double height = 0.6 * box_.height;
  const Box bar{box_.right() + 9, box_.y + 0.5 * (box_.height - height), width, height};
  constexpr int levels = 128;
  Picture colours(1, levels, white);
  for (int level = 0; level < levels; ++level)
    colours.at(0, level) = colour_of(1 - double(level) / (levels - 1));
  canvas.image(bar, colours);
  const Pen pen{ink, 0.6};
  canvas.frame(bar, pen);
  for (const double V : {0.0, 0.5, 1.0}) {
    const double y = bar.bottom() - V * height;
    canvas.line(std::array<Point, 2>{{{bar.right(), y}, {bar.right() + tick, y}}}, pen);
    canvas.text({bar.right() + tick + 2, y + 2.8}, fmt::format("{:g}", V), {.size = 7.5});
  }
  canvas.text({bar.x + 0.5 * width, bar.y - 6}, "V", {.size = 8.5, .align = 0.5});
}

}  // namespace myowave::apps
