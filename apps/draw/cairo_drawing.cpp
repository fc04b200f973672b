#include "apps/draw/cairo_drawing.hpp"

#include <numbers>
#include <stdexcept>

#include "apps/base/page.hpp"

namespace myowave::apps {
namespace {

void set_font(cairo_t* context, const TextStyle& style) {
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, style.size);
  // Letters have the same width at any scale, so that PNG and SVG have one layout; what fontconfig is set up
  // to do on a machine does not count.
  const std::unique_ptr<cairo_font_options_t, DestroyCairo> options(cairo_font_options_create());
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(context, options.get());
}

double advance(cairo_t* context, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.c_str(), &extents);
  return extents.x_advance;
}

}  // namespace

void require(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(std::string("cannot draw a figure: ") + cairo_status_to_string(status));
  }
}

double text_width(std::string_view text, const TextStyle& style) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  const CairoContext context(cairo_create(surface.get()));
  set_font(context.get(), style);
  return advance(context.get(), valid_text(text));
}

void draw_text(cairo_t* context, Point at, std::string_view text, const TextStyle& style) {
  const std::string valid = valid_text(text);
  cairo_save(context);
  set_font(context, style);
  set_colour(context, style.colour, 1);
  cairo_translate(context, at.x, at.y);
  if (style.upwards) cairo_rotate(context, -0.5 * std::numbers::pi);
  cairo_move_to(context, -style.align * advance(context, valid), 0);
  cairo_show_text(context, valid.c_str());
  cairo_new_path(context);
  cairo_restore(context);
}

void set_colour(cairo_t* context, Colour colour, double opacity) {
  cairo_set_source_rgba(context, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, opacity);
}

}  // namespace myowave::apps
