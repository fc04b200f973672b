// What a picture of results shows, as data: curves, the sheet, and panels of them. apps/draw/figure.hpp draws
// it.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/draw/colour_map.hpp"
#include "apps/draw/frame_shape.hpp"

namespace myowave::apps {

struct Axis {
  std::string label{}, unit{};         // "time", "s"; the unit may be empty
  std::optional<double> min{}, max{};  // else from the data
  bool logarithmic = false;            // what is not above zero is a gap
};

// Rings tell what a point does not: a bound instead of a value.
enum class Mark { line, points, rings, linked_points, steps, bars };

struct Series {
  std::string name{};            // empty: not in the legend
  std::vector<double> x{}, y{};  // NaN in either: a gap
  Mark mark = Mark::line;
  bool dashed = false;
  std::optional<int> colour{};  // number in the palette; else the series' own number
  std::vector<double> error{};  // half length of each error bar; empty: none
};

// Curves over two axes.
struct Plot {
  std::string title{};
  Axis x{}, y{};
  std::vector<Series> series{};
  bool equal_scales = false;     // one unit is as long on both axes (trajectories)
  std::vector<double> guides{};  // horizontal lines at these y
};

// V on the (deformed) sheet.
struct SheetPicture {
  std::string title{};
  FrameShape shape{};
  std::vector<double> V{};      // rows * columns
  std::vector<double> nodes{};  // as in solver::Frame; empty: rigid
  enum class Shading { colours, dark_above } shading = Shading::colours;
  double dark_above = 0.6;      // V, as in the paper's Figs 3, 4 and 9
  std::vector<Series> paths{};  // drawn over it, in the coordinates that the sheet is drawn in
};

using Panel = std::variant<Plot, SheetPicture>;

struct Figure {
  std::string title{};          // over all panels; may be empty
  int columns = 1;              // panels a row
  std::vector<Panel> panels{};  // row by row; labelled (a), (b), ... where there is more than one
};

// The colours of series: Okabe and Ito's, which colour-blind eyes tell apart, without their yellow, which is
// faint on white.
inline constexpr std::array<Colour, 7> palette{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {0, 0, 0}}};

// Of series number `n` of a plot.
Colour series_colour(const Series&, std::size_t n);

// What report.html draws a plot from: the members as they are named here, colours as "#rrggbb", six digits a
// number, null for NaN.
nlohmann::ordered_json plot_json(const Plot&);

}  // namespace myowave::apps
