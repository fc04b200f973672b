#include "apps/draw/strokes.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "apps/draw/cairo_drawing.hpp"

namespace myowave::apps {
namespace {

std::uint8_t mix(std::uint8_t from, std::uint8_t to, double part) {
  return static_cast<std::uint8_t>(std::lround(from + part * (to - from)));
}

Colour mix(const Colour& from, const Colour& to, double part) {
  return {mix(from.red, to.red, part), mix(from.green, to.green, part), mix(from.blue, to.blue, part)};
}

// Calls `mark(pixel, part)` for each pixel of the picture that is covered in part.
template <class Mark>
void for_covered(cairo_surface_t* coverage, Picture& picture, const Mark& mark) {
  cairo_surface_flush(coverage);
  require(cairo_surface_status(coverage));
  const unsigned char* row = cairo_image_surface_get_data(coverage);
  for (int y = 0; y < picture.height(); ++y, row += cairo_image_surface_get_stride(coverage)) {
    for (int x = 0; x < picture.width(); ++x) {
      // Most of a picture is not covered: eight pixels at a time.
      std::uint64_t eight = 1;
      while (x + 8 <= picture.width() && (std::memcpy(&eight, row + x, 8), eight == 0)) x += 8;
      if (x < picture.width() && row[x] != 0) mark(picture.at(x, y), row[x] / 255.0);
    }
  }
}

}  // namespace

struct Strokes::Impl {
  CairoSurface coverage;
  CairoContext context;
};

Strokes::Strokes(const Picture& picture) : impl_(std::make_unique<Impl>()) {
  impl_->coverage.reset(cairo_image_surface_create(CAIRO_FORMAT_A8, picture.width(), picture.height()));
  require(cairo_surface_status(impl_->coverage.get()));
  impl_->context.reset(cairo_create(impl_->coverage.get()));
  cairo_translate(impl_->context.get(), 0.5,
                  0.5);  // a Point counts from the middle of a pixel, cairo from its corner
  cairo_set_line_join(impl_->context.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(impl_->context.get(), CAIRO_LINE_CAP_ROUND);
}

Strokes::~Strokes() = default;

void Strokes::line(std::span<const Point> points, double width) {
  cairo_t* context = impl_->context.get();
  for (const Point& point : points) cairo_line_to(context, point.x, point.y);
  cairo_set_line_width(context, width);
  cairo_stroke(context);
}

void Strokes::text(Point at, std::string_view text, const TextStyle& style) {
  draw_text(impl_->context.get(), at, text, style);
}

void Strokes::paint(Picture& picture, Colour colour, double opacity) {
  for_covered(impl_->coverage.get(), picture,
              [&](Colour& pixel, double part) { pixel = mix(pixel, colour, opacity * part); });
}

void Strokes::paint_contrast(Picture& picture, double opacity) {
  // Half way between black and white for the eye (CIELAB L* = 50).
  constexpr double middle = 0.184;
  for_covered(impl_->coverage.get(), picture, [&](Colour& pixel, double part) {
    const Colour ink = luminance(pixel) > middle ? Colour{0, 0, 0} : Colour{255, 255, 255};
    pixel = mix(pixel, ink, opacity * part);
  });
}

}  // namespace myowave::apps
