// How a text in a figure or a frame looks.
#pragma once

#include <string_view>

#include "apps/draw/colour_map.hpp"

namespace myowave::apps {

struct TextStyle {
  double size = 9;  // in the units of what it is drawn on
  bool bold = false;
  double align = 0;      // part of the width that is left of the point: 0, 0.5 or 1
  bool upwards = false;  // reads from below
  Colour colour{30, 30, 30};
};

// The width of a text in the font of all figures, DejaVu Sans.
double text_width(std::string_view, const TextStyle&);

}  // namespace myowave::apps
