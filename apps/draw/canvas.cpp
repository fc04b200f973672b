#include "apps/draw/canvas.hpp"

#include <cairo-svg.h>

#include <cmath>
#include <numbers>

#include "apps/draw/cairo_drawing.hpp"

namespace myowave::apps {
namespace {

cairo_status_t append(void* text, const unsigned char* bytes, unsigned length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), length);
  return CAIRO_STATUS_SUCCESS;
}

void stroke(cairo_t* context, const Pen& pen) {
  set_colour(context, pen.colour, pen.opacity);
  cairo_set_line_width(context, pen.width);
  const double dash[] = {4, 2.5};
  cairo_set_dash(context, dash, pen.dashed ? 2 : 0, 0);
  cairo_stroke(context);
}

}  // namespace

struct Canvas::Impl {
  Format format;
  std::string bytes;  // before the surface, which may write to it at its end
  CairoSurface surface;
  CairoContext context;
};

Canvas::Canvas(Format format, double width, double height) : impl_(std::make_unique<Impl>()) {
  impl_->format = format;
  const double scale = format == Format::png ? pixels_per_point : 1;
  if (format == Format::png) {
    impl_->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(std::ceil(scale * width)),
                                                    int(std::ceil(scale * height))));
  } else {
    impl_->surface.reset(cairo_svg_surface_create_for_stream(append, &impl_->bytes, width, height));
  }
  require(cairo_surface_status(impl_->surface.get()));
  impl_->context.reset(cairo_create(impl_->surface.get()));
  cairo_scale(impl_->context.get(), scale, scale);
  cairo_set_line_join(impl_->context.get(), CAIRO_LINE_JOIN_ROUND);
  rectangle({0, 0, width + 1, height + 1}, {255, 255, 255});
}

Canvas::~Canvas() = default;

void Canvas::line(std::span<const Point> points, const Pen& pen) {
  if (points.empty()) return;
  cairo_t* context = impl_->context.get();
  cairo_move_to(context, points[0].x, points[0].y);
  for (const Point& point : points.subspan(1)) cairo_line_to(context, point.x, point.y);
  stroke(context, pen);
}

void Canvas::rectangle(const Box& box, Colour fill, double opacity) {
  cairo_rectangle(impl_->context.get(), box.x, box.y, box.width, box.height);
  set_colour(impl_->context.get(), fill, opacity);
  cairo_fill(impl_->context.get());
}

void Canvas::frame(const Box& box, const Pen& pen) {
  const Point corners[] = {{box.x, box.y},
                           {box.right(), box.y},
                           {box.right(), box.bottom()},
                           {box.x, box.bottom()},
                           {box.x, box.y}};
  line(corners, pen);
}

void Canvas::disc(Point centre, double radius, Colour colour) {
  cairo_new_sub_path(impl_->context.get());
  cairo_arc(impl_->context.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  set_colour(impl_->context.get(), colour, 1);
  cairo_fill(impl_->context.get());
}

void Canvas::ring(Point centre, double radius, const Pen& pen) {
  cairo_new_sub_path(impl_->context.get());
  cairo_arc(impl_->context.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  stroke(impl_->context.get(), pen);
}

void Canvas::text(Point at, std::string_view text, const TextStyle& style) {
  draw_text(impl_->context.get(), at, text, style);
}

void Canvas::image(const Box& box, const Picture& picture) {
  const CairoSurface pixels(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width(), picture.height()));
  require(cairo_surface_status(pixels.get()));
  const int stride = cairo_image_surface_get_stride(pixels.get()) / 4;
  auto* data = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(pixels.get()));
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const Colour& colour = picture.at(x, y);
      data[std::ptrdiff_t(y) * stride + x] =
          std::uint32_t(colour.red) << 16U | std::uint32_t(colour.green) << 8U | colour.blue;
    }
  cairo_surface_mark_dirty(pixels.get());
  cairo_t* context = impl_->context.get();
  cairo_save(context);
  cairo_translate(context, box.x, box.y);
  cairo_scale(context, box.width / picture.width(), box.height / picture.height());
  cairo_set_source_surface(context, pixels.get(), 0, 0);
  // The pixels at the edges do not fade into the ground.
  cairo_pattern_set_extend(cairo_get_source(context), CAIRO_EXTEND_PAD);
  cairo_rectangle(context, 0, 0, picture.width(), picture.height());
  cairo_fill(context);
  cairo_restore(context);
}

void Canvas::enter(Point corner) {
  cairo_save(impl_->context.get());
  cairo_translate(impl_->context.get(), corner.x, corner.y);
}

void Canvas::enter_clip(const Box& box) {
  cairo_save(impl_->context.get());
  cairo_rectangle(impl_->context.get(), box.x, box.y, box.width, box.height);
  cairo_clip(impl_->context.get());
}

void Canvas::leave() { cairo_restore(impl_->context.get()); }

std::string Canvas::content() {
  require(cairo_status(impl_->context.get()));
  impl_->context.reset();
  if (impl_->format == Format::png) {
    require(cairo_surface_write_to_png_stream(impl_->surface.get(), append, &impl_->bytes));
  } else {
    cairo_surface_finish(impl_->surface.get());
  }
  require(cairo_surface_status(impl_->surface.get()));
  return std::move(impl_->bytes);
}

}  // namespace myowave::apps
