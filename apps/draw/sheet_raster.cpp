#include "apps/draw/sheet_raster.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace myowave::apps {
namespace {

double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }

// The bilinear map of one element from (xi, eta) in [0, 1]^2 and its inverse.
struct Bilinear {
  Point origin, along_xi, along_eta, twist;

  Bilinear(Point x00, Point x10, Point x01, Point x11)
      : origin(x00),
        along_xi{x10.x - x00.x, x10.y - x00.y},
        along_eta{x01.x - x00.x, x01.y - x00.y},
        twist{x00.x - x10.x - x01.x + x11.x, x00.y - x10.y - x01.y + x11.y} {}

  // (xi, eta) of p, where p lies in the element.
  std::optional<Point> inverse(Point p) const {
    const Point d{p.x - origin.x, p.y - origin.y};
    // a eta^2 + b eta + c = 0; with b < 0 in an element that is not inverted, the root that stays
    // finite for a parallelogram (a = 0) is 2 c / (-b + sqrt(b^2 - 4 a c)).
    const double a = cross(twist, along_eta);
    const double b = cross(along_xi, along_eta) + cross(d, twist);
    const double c = cross(d, along_xi);
    const double under_root = b * b - 4 * a * c;
    if (under_root < 0) return std::nullopt;
    const double q = -0.5 * (b + std::copysign(std::sqrt(under_root), b));
    if (const auto found = with_eta(d, c / q)) return found;
    return a != 0 ? with_eta(d, q / a) : std::nullopt;
  }

 private:
  std::optional<Point> with_eta(Point d, double eta) const {
    // Pixels on the line between two elements belong to both.
    constexpr double edge = 1e-9;
    if (!(eta >= -edge && eta <= 1 + edge)) return std::nullopt;
    const Point e{along_xi.x + twist.x * eta, along_xi.y + twist.y * eta};
    const double xi =
        std::abs(e.x) > std::abs(e.y) ? (d.x - along_eta.x * eta) / e.x : (d.y - along_eta.y * eta) / e.y;
    if (!(xi >= -edge && xi <= 1 + edge)) return std::nullopt;
    return Point{std::clamp(xi, 0.0, 1.0), std::clamp(eta, 0.0, 1.0)};
  }
};

// Number of the element columns that are drawn.
int columns_of(const FrameShape& shape) { return std::max(1, shape.element_columns()); }
int rows_of(const FrameShape& shape) { return std::max(1, shape.element_rows()); }

Point node_pixel(const Sheet& sheet, const SheetView& view, int I, int J) {
  const std::size_t node = 2 * (std::size_t(I) * std::size_t(columns_of(sheet.shape) + 1) + std::size_t(J));
  return view.to_pixel(sheet.nodes[node], sheet.nodes[node + 1]);
}

void fill_element(Picture& picture, const Sheet& sheet, const SheetView& view, int I, int J,
                  const std::function<Colour(double)>& colour) {
  const FrameShape& shape = sheet.shape;
  const std::array<Point, 4> corners{node_pixel(sheet, view, I, J), node_pixel(sheet, view, I, J + 1),
                                     node_pixel(sheet, view, I + 1, J),
                                     node_pixel(sheet, view, I + 1, J + 1)};
  const Bilinear map(corners[0], corners[1], corners[2], corners[3]);
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x, corners[3].x});
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
  const int cells_1 = shape.deforms() ? shape.cells : shape.columns - 1;
  const int cells_2 = shape.deforms() ? shape.cells : shape.rows - 1;
  const int last_x = std::min(picture.width() - 1, int(std::floor(right)));
  const int last_y = std::min(picture.height() - 1, int(std::floor(bottom)));
  for (int y = std::max(0, int(std::ceil(top))); y <= last_y; ++y) {
    for (int x = std::max(0, int(std::ceil(left))); x <= last_x; ++x) {
      const auto at = map.inverse({double(x), double(y)});
      if (at) picture.at(x, y) = colour(sheet_V(sheet, cells_2 * (I + at->y), cells_1 * (J + at->x)));
    }
  }
}

void draw_lines(Picture& picture, Strokes& border, const Sheet& sheet, const SheetView& view, double width) {
  const int rows = rows_of(sheet.shape), columns = columns_of(sheet.shape);
  Strokes inner(picture);
  std::vector<Point> line;
  const auto draw = [&](bool outer) {
    (outer ? border : inner).line(line, outer ? 2.2 * width : width);
    line.clear();
  };
  for (int I = 0; I <= rows; ++I) {
    for (int J = 0; J <= columns; ++J) line.push_back(node_pixel(sheet, view, I, J));
    draw(I == 0 || I == rows);
  }
  for (int J = 0; J <= columns; ++J) {
    for (int I = 0; I <= rows; ++I) line.push_back(node_pixel(sheet, view, I, J));
    draw(J == 0 || J == columns);
  }
  inner.paint_contrast(picture, 0.32);
}

}  // namespace

double sheet_V(const Sheet& sheet, double row, double column) {
  const int i = std::min(int(row), sheet.shape.rows - 2), j = std::min(int(column), sheet.shape.columns - 2);
  const double u = column - j, v = row - i;
  const double* V = sheet.V.data() + std::size_t(i) * std::size_t(sheet.shape.columns) + std::size_t(j);
  const double* above = V + sheet.shape.columns;
  return (1 - v) * ((1 - u) * V[0] + u * V[1]) + v * ((1 - u) * above[0] + u * above[1]);
}

std::array<double, 8> sheet_corners(const FrameShape& shape) {
  const double length_1 = (shape.columns - 1) * shape.dx, length_2 = (shape.rows - 1) * shape.dx;
  return {0, 0, length_1, 0, 0, length_2, length_1, length_2};
}

void draw_sheet(Picture& picture, Strokes& border, const Sheet& given, const SheetView& view,
                const std::function<Colour(double)>& colour, double line_width) {
  const auto corners = sheet_corners(given.shape);
  Sheet sheet = given;
  if (!sheet.shape.deforms()) sheet.nodes = corners;
  for (int I = 0; I < rows_of(sheet.shape); ++I)
    for (int J = 0; J < columns_of(sheet.shape); ++J) fill_element(picture, sheet, view, I, J, colour);
  draw_lines(picture, border, sheet, view, line_width);
}

}  // namespace myowave::apps
