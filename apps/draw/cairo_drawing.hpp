// What figures and frames share of cairo: handles, errors and text.
#pragma once

#include <cairo.h>

#include <memory>
#include <string>
#include <string_view>

#include "apps/draw/picture.hpp"
#include "apps/draw/text_style.hpp"

namespace myowave::apps {

struct DestroyCairo {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};
using CairoSurface = std::unique_ptr<cairo_surface_t, DestroyCairo>;
using CairoContext = std::unique_ptr<cairo_t, DestroyCairo>;

// Errors: std::runtime_error with cairo's reason where it did not succeed.
void require(cairo_status_t);

// The point is on the base line. Bytes that are no UTF-8 show as U+FFFD.
void draw_text(cairo_t*, Point, std::string_view, const TextStyle&);

void set_colour(cairo_t*, Colour, double opacity);

}  // namespace myowave::apps
