#include "apps/draw/frame_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/mechanics/equibiaxial.hpp"

namespace myowave::apps {
namespace {

// Layout, pixels.
constexpr int view_size = 860;  // longer side of the view
constexpr int smallest_view = 160;
constexpr int margin = 16;
constexpr int header = 48;
constexpr int colour_bar_space = 84;
constexpr int colour_bar_width = 18;
constexpr TextStyle title_style{.size = 22};
constexpr TextStyle label_style{.size = 16};
constexpr double half_digit = 0.36 * label_style.size;  // of the height of digits in DejaVu Sans

// How far the sheet leaves its place at rest, of its size: parts that contract turn it about its pin.
constexpr double slack = 1.12;

constexpr Colour white{255, 255, 255};
constexpr Colour ink{30, 30, 30};

int even(double size) { return 2 * int(std::ceil(size / 2)); }  // video encoders ask for it

}  // namespace

FramePicture::FramePicture(const solver::Scene& scene)
    : shape_(frame_shape(scene)), ms_per_tu_(scene.time.ms_per_tu) {
  const double length_1 = (shape_.columns - 1) * shape_.dx, length_2 = (shape_.rows - 1) * shape_.dx;
  const double ms_per_frame = scene.output.every * ms_per_tu_;
  decimals_ = std::abs(ms_per_frame - std::round(ms_per_frame)) < 1e-9 ? 0 : 1;
  double x = 0, y = 0, width = length_1, height = length_2;
  if (scene.mechanics && scene.mechanics->edges == solver::Edges::load) {
    // The sheet grows about its pinned node.
    const double h = shape_.cells * shape_.dx;
    const double pin_1 = shape_.element_columns() / 2 * h, pin_2 = shape_.element_rows() / 2 * h;
    const double at_rest = solver::equibiaxial_stretch(*scene.mechanics, 0).value_or(1);
    const double stretch = slack * std::max(1.0, at_rest);
    const double reach_1 = stretch * std::max(pin_1, length_1 - pin_1);
    const double reach_2 = stretch * std::max(pin_2, length_2 - pin_2);
    x = pin_1 - reach_1;
    y = pin_2 - reach_2;
    width = 2 * reach_1;
    height = 2 * reach_2;
  }
  const double scale = view_size / std::max(width, height);
  view_width_ = even(std::max(scale * width, double(smallest_view)));
  view_height_ = even(std::max(scale * height, double(smallest_view)));
  view_ = {.x = x - 0.5 * (view_width_ / scale - width),
           .y = y - 0.5 * (view_height_ / scale - height),
           .pixel = {margin, double(header + view_height_)},
           .scale = scale};
}

void FramePicture::draw_labels(Picture& picture, Strokes& text, double t) const {
  text.text({margin, header - 17.0}, fmt::format("t = {:.{}f} ms", t * ms_per_tu_, decimals_), title_style);

  const int left = margin + view_width_ + margin;
  const int height = std::min(view_height_ - 40, 320);
  const int bottom = header + (view_height_ + height) / 2, top = bottom - height;
  for (int y = top; y <= bottom; ++y) {
    const Colour colour = colour_of(double(bottom - y) / height);
    for (int x = left; x < left + colour_bar_width; ++x) picture.at(x, y) = colour;
  }
  const double l = left, r = left + colour_bar_width, b = bottom, u = top;
  text.line(std::array<Point, 5>{{{l, b}, {r, b}, {r, u}, {l, u}, {l, b}}}, 1);
  for (const char* label : {"0", "0.5", "1"}) {
    const double y = bottom - std::stod(label) * height;
    text.line(std::array<Point, 2>{{{r, y}, {r + 5, y}}}, 1);
    text.text({r + 10, y + half_digit}, label, label_style);
  }
  TextStyle above = title_style;
  above.align = 0.5;
  text.text({l + 0.5 * colour_bar_width, u - 12}, "V", above);
}

Picture FramePicture::draw(const solver::Frame& frame) const {
  Picture picture(margin + view_width_ + colour_bar_space, header + view_height_ + margin, white);
  Strokes strokes(picture);
  draw_sheet(picture, strokes, {shape_, frame.V, frame.nodes}, view_, colour_of);
  draw_labels(picture, strokes, frame.t);
  strokes.paint(picture, ink, 1);
  return picture;
}

}  // namespace myowave::apps
