// The colours of V.
#pragma once

#include <array>
#include <cstdint>

namespace myowave::apps {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

// 0 (rest) is light, 1 (excited) dark, as in the paper's Figs 3 and 4; values outside are clamped.
// CIELAB lightness falls linearly from 97 to 14, so that equal steps of V look equal, also in grey
// and to colour-blind eyes; the hue goes from cream over green and blue to navy.
Colour colour_of(double value);

// Relative luminance in [0, 1] (sRGB, IEC 61966-2-1).
double luminance(const Colour&);

}  // namespace myowave::apps
