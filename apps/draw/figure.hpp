// Figures as a journal prints them: white ground, thin axes, round ticks, letters on the panels.
#pragma once

#include <filesystem>
#include <string>

#include "apps/draw/plot.hpp"

namespace myowave::apps {

// SVG 1.1 whose letters are outlines, so that it looks the same everywhere; the titles stand in its <title>.
// A sheet is an image in it.
std::string figure_svg(const Figure&);

// The same as PNG, 480 pixels a panel's width.
std::string figure_png(const Figure&);

// STEM.png and STEM.svg.
// Errors: std::runtime_error "cannot write FILE: reason".
void write_figure(const Figure&, const std::filesystem::path& stem);

}  // namespace myowave::apps
