#include "apps/frame_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace myowave::apps {
namespace {

// Layout, pixels.
constexpr int view_size = 860;  // longer side of the view
constexpr int smallest_view = 160;
constexpr int margin = 16;
constexpr int header = 48;
constexpr int colour_bar_space = 84;
constexpr int colour_bar_width = 18;
constexpr double text_height = 17;
constexpr double label_height = 12;

// How far the sheet leaves its place at rest, of its size: parts that contract turn it about its pin.
constexpr double slack = 1.12;

constexpr Colour white{255, 255, 255};
constexpr Colour ink{30, 30, 30};

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

// V between the grid nodes.
double sample(const solver::Frame& frame, double row, double column) {
  const int i = std::min(int(row), frame.rows - 2), j = std::min(int(column), frame.columns - 2);
  const double u = column - j, v = row - i;
  const double* V = frame.V.data() + std::size_t(i) * std::size_t(frame.columns) + std::size_t(j);
  const double* above = V + frame.columns;
  return (1 - v) * ((1 - u) * V[0] + u * V[1]) + v * ((1 - u) * above[0] + u * above[1]);
}

int even(double size) { return 2 * int(std::ceil(size / 2)); }  // video encoders ask for it

}  // namespace

double rest_stretch(const solver::MechanicsSettings& m) {
  if (m.edges == solver::Edges::fixed) return 1;
  // Uniform equibiaxial stretch: the tension of the membrane per deformed (follower) or undeformed
  // (dead) length grows with the stretch and equals p.
  const auto excess = [&m](double stretch) {
    const double per_deformed = 2 * (1 - std::pow(stretch, -6)) * (m.c1 + m.c2 * stretch * stretch);
    return per_deformed * (m.load == solver::Load::dead ? stretch : 1.0) - m.p;
  };
  double low = 0.1, high = 10;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

FramePicture::FramePicture(const solver::Scene& scene)
    : shape_(frame_shape(scene)), ms_per_tu_(scene.time.ms_per_tu) {
  const double length_1 = (shape_.columns - 1) * shape_.dx, length_2 = (shape_.rows - 1) * shape_.dx;
  const double ms_per_frame = scene.output.every * ms_per_tu_;
  decimals_ = std::abs(ms_per_frame - std::round(ms_per_frame)) < 1e-9 ? 0 : 1;
  view_x_ = view_y_ = 0;
  double width = length_1, height = length_2;
  if (scene.mechanics && scene.mechanics->edges == solver::Edges::load) {
    // The sheet grows about its pinned node.
    const double h = shape_.cells * shape_.dx;
    const double pin_1 = shape_.element_columns() / 2 * h, pin_2 = shape_.element_rows() / 2 * h;
    const double stretch = slack * std::max(1.0, rest_stretch(*scene.mechanics));
    const double reach_1 = stretch * std::max(pin_1, length_1 - pin_1);
    const double reach_2 = stretch * std::max(pin_2, length_2 - pin_2);
    view_x_ = pin_1 - reach_1;
    view_y_ = pin_2 - reach_2;
    width = 2 * reach_1;
    height = 2 * reach_2;
  }
  scale_ = view_size / std::max(width, height);
  view_width_ = even(std::max(scale_ * width, double(smallest_view)));
  view_height_ = even(std::max(scale_ * height, double(smallest_view)));
  view_x_ -= 0.5 * (view_width_ / scale_ - width);
  view_y_ -= 0.5 * (view_height_ / scale_ - height);
}

Point FramePicture::to_pixel(double x1, double x2) const {
  return {margin + scale_ * (x1 - view_x_), header + view_height_ - scale_ * (x2 - view_y_)};
}

void FramePicture::fill_element(Picture& picture, const solver::Frame& frame, std::span<const double> nodes,
                                int I, int J) const {
  const int element_columns = std::max(1, shape_.element_columns());
  const auto corner = [&](int up, int right) {
    const std::size_t node =
        2 * (std::size_t(I + up) * std::size_t(element_columns + 1) + std::size_t(J + right));
    return to_pixel(nodes[node], nodes[node + 1]);
  };
  const std::array<Point, 4> corners{corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)};
  const Bilinear map(corners[0], corners[1], corners[2], corners[3]);
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x, corners[3].x});
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
  const int cells_1 = shape_.deforms() ? shape_.cells : shape_.columns - 1;
  const int cells_2 = shape_.deforms() ? shape_.cells : shape_.rows - 1;
  const int last_x = std::min(picture.width() - 1, int(std::floor(right)));
  const int last_y = std::min(picture.height() - 1, int(std::floor(bottom)));
  for (int y = std::max(0, int(std::ceil(top))); y <= last_y; ++y) {
    for (int x = std::max(0, int(std::ceil(left))); x <= last_x; ++x) {
      const auto at = map.inverse({double(x), double(y)});
      if (at) picture.at(x, y) = colour_of(sample(frame, cells_2 * (I + at->y), cells_1 * (J + at->x)));
    }
  }
}

void FramePicture::draw_lines(Picture& picture, Strokes& border, std::span<const double> nodes) const {
  const int rows = std::max(1, shape_.element_rows()), columns = std::max(1, shape_.element_columns());
  const auto node = [&](int I, int J) {
    const std::size_t n = 2 * (std::size_t(I) * std::size_t(columns + 1) + std::size_t(J));
    return to_pixel(nodes[n], nodes[n + 1]);
  };
  Strokes inner(picture);
  for (int I = 0; I <= rows; ++I) {
    for (int J = 0; J <= columns; ++J) {
      const bool outer_row = I == 0 || I == rows, outer_column = J == 0 || J == columns;
      if (J < columns) (outer_row ? border : inner).line(node(I, J), node(I, J + 1), outer_row ? 2.2 : 1.0);
      if (I < rows)
        (outer_column ? border : inner).line(node(I, J), node(I + 1, J), outer_column ? 2.2 : 1.0);
    }
  }
  inner.paint_contrast(picture, 0.32);
}

void FramePicture::draw_labels(Picture& picture, Strokes& text, double t) const {
  text.text({margin, header - 17.0}, text_height, fmt::format("t = {:.{}f} ms", t * ms_per_tu_, decimals_));

  const int left = margin + view_width_ + margin;
  const int height = std::min(view_height_ - 40, 320);
  const int bottom = header + (view_height_ + height) / 2, top = bottom - height;
  for (int y = top; y <= bottom; ++y) {
    const Colour colour = colour_of(double(bottom - y) / height);
    for (int x = left; x < left + colour_bar_width; ++x) picture.at(x, y) = colour;
  }
  const double l = left, r = left + colour_bar_width, b = bottom, u = top;
  for (const auto& [from, to] : std::array<std::pair<Point, Point>, 4>{
           {{{l, b}, {r, b}}, {{r, b}, {r, u}}, {{r, u}, {l, u}}, {{l, u}, {l, b}}}}) {
    text.line(from, to, 1);
  }
  for (const char* label : {"0", "0.5", "1"}) {
    const double y = bottom - std::stod(label) * height;
    text.line({r, y}, {r + 5, y}, 1);
    text.text({r + 10, y + 0.5 * label_height}, label_height, label);
  }
  text.text({l + 0.5 * (colour_bar_width - text_width(text_height, "V")) + 2, u - 12}, text_height, "V");
}

Picture FramePicture::draw(const solver::Frame& frame) const {
  Picture picture(margin + view_width_ + colour_bar_space, header + view_height_ + margin, white);
  const double length_1 = (shape_.columns - 1) * shape_.dx, length_2 = (shape_.rows - 1) * shape_.dx;
  const std::array<double, 8> undeformed{0, 0, length_1, 0, 0, length_2, length_1, length_2};
  const std::span<const double> nodes = shape_.deforms() ? frame.nodes : std::span<const double>(undeformed);
  for (int I = 0; I < std::max(1, shape_.element_rows()); ++I) {
    for (int J = 0; J < std::max(1, shape_.element_columns()); ++J) fill_element(picture, frame, nodes, I, J);
  }
  Strokes strokes(picture);
  draw_lines(picture, strokes, nodes);
  draw_labels(picture, strokes, frame.t);
  strokes.paint(picture, ink, 1);
  return picture;
}

}  // namespace myowave::apps
