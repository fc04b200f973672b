#include "apps/draw/map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/base/page.hpp"
#include "apps/draw/plot_axes.hpp"

namespace myowave::apps {
namespace {

using solver::MapTable;

// Layout, pixels.
constexpr int plot_width = 300, plot_height = 240;
constexpr int left = 72, right = 18, top = 34, bottom = 50;  // around a plot
constexpr int legend_line = 24, under_legend = 12;
constexpr int panels_in_a_row = 2;

constexpr std::array<std::string_view, 3> line_dashes{"none", "7 4", "2 3"};

// From light to dark, so that a worse outcome is darker in grey and to colour-blind eyes too.
constexpr std::array<std::string_view, 7> colours{"#fbf1b8", "#fdd98f", "#fdb95e", "#ee7b30",
                                                  "#cc3f38", "#8a1f45", "#3f0d3a"};

std::string_view colour_of_outcome(std::size_t outcome, std::size_t outcomes) {
  return outcomes < 2 ? colours.front() : colours[outcome * (colours.size() - 1) / (outcomes - 1)];
}

std::size_t column_of(const MapTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.columns, name, &solver::MapColumn::name);
  return static_cast<std::size_t>(found - table.columns.begin());
}

double number(const MapTable& table, const solver::MapRow& row, const std::string& column) {
  return std::get<double>(row.cells[column_of(table, column)]);
}

// Of a column that is drawn along y.
double y_number(const MapTable& table, const solver::MapRow& row, const std::string& column) {
  const std::string& divisor = table.view->y_in;
  return number(table, row, column) / (divisor.empty() ? 1 : number(table, row, divisor));
}

const std::string& unit_of(const MapTable& table, const std::string& name) {
  return table.columns[column_of(table, name)].unit;
}

std::string text_of(const solver::MapCell& cell) {
  if (const auto* value = std::get_if<double>(&cell)) return fmt::format("{:g}", *value);
  const auto* text = std::get_if<std::string>(&cell);
  return text ? *text : "";
}

// An axis of all panels, from values to pixels.
struct MapAxis {
  Axis axis;
  AxisRange range{};        // in places
  double from = 0, to = 1;  // pixels of the range's ends

  double pixel(double value) const {
    return from + (to - from) * (place_on(axis, value) - range.low) / range.length();
  }
  Ticks ticks() const {
    constexpr int most = 6;
    return axis.logarithmic ? decade_ticks(range, most) : round_ticks(range, most);
  }
};

// The cell of each value in a sorted row of them: half way to its neighbours.
std::map<double, std::pair<double, double>> intervals(std::vector<double> values, bool logarithmic) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
  const auto scale = [&](double value) { return logarithmic ? std::log(value) : value; };
  const auto back = [&](double value) { return logarithmic ? std::exp(value) : value; };
  std::map<double, std::pair<double, double>> result;
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double here = scale(values[n]);
    const double below = n > 0 ? scale(values[n - 1]) : 0;
    const double above = n + 1 < values.size() ? scale(values[n + 1]) : 0;
    const double lone = logarithmic ? 0.1 : 0.5;
    const double up = n + 1 < values.size() ? 0.5 * (above - here) : n > 0 ? 0.5 * (here - below) : lone;
    const double down = n > 0 ? 0.5 * (here - below) : up;
    result[values[n]] = {back(here - down), back(here + up)};
  }
  return result;
}

struct Rectangle {
  std::pair<double, double> x, y;
  std::size_t outcome;
};

struct MapPanel {
  std::vector<Rectangle> cells;
  std::vector<std::map<double, double>> lines;  // y over x
};

// By title, in the order of the table.
using Panels = std::vector<std::pair<std::string, MapPanel>>;

std::string panel_title(const MapTable& table, const solver::MapRow& row) {
  std::string title;
  for (const auto& name : table.view->panels)
    title += (title.empty() ? "" : ", ") + text_of(row.cells[column_of(table, name)]);
  return title;
}

MapPanel make_panel(const MapTable& table, const std::vector<const solver::MapRow*>& rows) {
  const solver::MapView& view = *table.view;
  MapPanel panel{{}, std::vector<std::map<double, double>>(view.lines.size())};
  std::vector<double> all_x;
  std::map<double, std::vector<double>> all_y;
  for (const auto* row : rows) {
    const double x = number(table, *row, view.x);
    all_x.push_back(x);
    all_y[x].push_back(y_number(table, *row, view.y));
    for (std::size_t n = 0; n < view.lines.size(); ++n)
      panel.lines[n][x] = y_number(table, *row, view.lines[n].column);
  }
  const auto x_cells = intervals(all_x, view.log_x);
  std::map<double, std::map<double, std::pair<double, double>>> y_cells;
  for (const auto& [x, values] : all_y) y_cells[x] = intervals(values, view.log_y);
  for (const auto* row : rows) {
    const double x = number(table, *row, view.x);
    panel.cells.push_back({x_cells.at(x), y_cells.at(x).at(y_number(table, *row, view.y)), row->outcome});
  }
  return panel;
}

Panels make_panels(const MapTable& table) {
  std::vector<std::pair<std::string, std::vector<const solver::MapRow*>>> rows;
  for (const auto& row : table.rows) {
    const std::string title = panel_title(table, row);
    auto found = std::ranges::find(rows, title, [](const auto& one) { return one.first; });
    if (found == rows.end()) found = rows.insert(rows.end(), {title, {}});
    found->second.push_back(&row);
  }
  Panels panels;
  for (const auto& [title, of_panel] : rows) panels.emplace_back(title, make_panel(table, of_panel));
  return panels;
}

// The same axes in all panels, so that they compare by eye.
std::pair<MapAxis, MapAxis> common_axes(const Panels& panels, const MapTable& table) {
  const solver::MapView& view = *table.view;
  MapAxis x{{.label = view.x, .unit = unit_of(table, view.x), .logarithmic = view.log_x}};
  MapAxis y{{.label = view.y, .unit = unit_of(table, view.y), .logarithmic = view.log_y}};
  if (!view.y_in.empty()) y.axis.label += " / " + view.y_in, y.axis.unit.clear();
  std::vector<double> x_places, y_places;
  for (const auto& [title, panel] : panels)
    for (const auto& cell : panel.cells) {
      for (const double value : {cell.x.first, cell.x.second}) x_places.push_back(place_on(x.axis, value));
      for (const double value : {cell.y.first, cell.y.second}) y_places.push_back(place_on(y.axis, value));
    }
  x.range = axis_range(x.axis, x_places, 0), x.to = plot_width;
  y.range = axis_range(y.axis, y_places, 0), y.from = plot_height, y.to = 0;
  return {x, y};
}

std::string label(double x, double y, std::string_view text, std::string_view attributes = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, html_escape(text));
}

std::string draw_axes(const MapAxis& x, const MapAxis& y) {
  std::string svg = fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#222\"/>\n",
                                plot_width, plot_height);
  const Ticks x_ticks = x.ticks(), y_ticks = y.ticks();
  for (std::size_t n = 0; n < x_ticks.values.size(); ++n) {
    const double at = x.pixel(x_ticks.values[n]);
    svg += fmt::format("<path d=\"M{:.1f} {}v5\" stroke=\"#222\"/>\n", at, plot_height);
    svg += label(at, plot_height + 18, x_ticks.labels[n], "text-anchor=\"middle\"");
  }
  for (std::size_t n = 0; n < y_ticks.values.size(); ++n) {
    const double at = y.pixel(y_ticks.values[n]);
    svg += fmt::format("<path d=\"M0 {:.1f}h-5\" stroke=\"#222\"/>\n", at);
    svg += label(-8, at + 4, y_ticks.labels[n], "text-anchor=\"end\"");
  }
  svg += label(0.5 * plot_width, plot_height + 38, axis_text(x.axis, x_ticks.exponent),
               "text-anchor=\"middle\"");
  svg += label(
      0, 0, axis_text(y.axis, y_ticks.exponent),
      fmt::format("text-anchor=\"middle\" transform=\"translate(-54 {}) rotate(-90)\"", plot_height / 2));
  return svg;
}

std::string line_style(std::size_t number) {
  return fmt::format(
      "clip-path=\"url(#plot)\" fill=\"none\" stroke=\"#0050c8\" stroke-width=\"2\" stroke-dasharray=\"{}\"",
      line_dashes[number % line_dashes.size()]);
}

std::string draw_panel(const MapTable& table, const MapPanel& panel, const MapAxis& x, const MapAxis& y) {
  std::string svg = "<g stroke=\"#fff\" stroke-width=\"0.5\">\n";
  for (const auto& cell : panel.cells) {
    const double l = x.pixel(cell.x.first), r = x.pixel(cell.x.second);
    const double b = y.pixel(cell.y.first), t = y.pixel(cell.y.second);
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                       l, t, r - l, b - t, colour_of_outcome(cell.outcome, table.outcomes.size()));
  }
  svg += "</g>\n";
  for (std::size_t n = 0; n < panel.lines.size(); ++n) {
    std::string points;
    for (const auto& [at, value] : panel.lines[n])
      points += fmt::format("{:.1f},{:.1f} ", x.pixel(at), y.pixel(value));
    svg += fmt::format("<polyline points=\"{}\" {}/>\n", points, line_style(n));
  }
  return svg + draw_axes(x, y);
}

struct Legend {
  std::string svg;
  int height = legend_line + under_legend;
};

// In as many lines as a picture of that width needs.
Legend draw_legend(const MapTable& table, int width) {
  Legend legend;
  double at = left;
  const auto entry = [&](const std::string& mark, const std::string& text) {
    const double length = 26 + 7.2 * static_cast<double>(text.size());
    if (at > left && at + length > width) {
      at = left;
      legend.height += legend_line;
    }
    const int y = legend.height - legend_line;
    legend.svg += fmt::format("<g transform=\"translate({:.1f} {})\">{}</g>\n", at, y, mark) +
                  label(at + 26, y + 11, text);
    at += length + 18;
  };
  for (std::size_t outcome = 0; outcome < table.outcomes.size(); ++outcome)
    entry(fmt::format("<rect width=\"16\" height=\"13\" fill=\"{}\" stroke=\"#222\"/>",
                      colour_of_outcome(outcome, table.outcomes.size())),
          table.outcomes[outcome]);
  for (std::size_t n = 0; n < table.view->lines.size(); ++n)
    entry(fmt::format("<path d=\"M-4 7h24\" {}/>", line_style(n)), table.view->lines[n].label);
  return legend;
}

}  // namespace

std::string map_svg(const MapTable& table) {
  const Panels panels = make_panels(table);
  const auto [x, y] = common_axes(panels, table);
  const int across = std::min<int>(panels_in_a_row, static_cast<int>(panels.size()));
  const int down = (static_cast<int>(panels.size()) + across - 1) / across;
  constexpr int panel_width = left + plot_width + right, panel_height = top + plot_height + bottom;
  const int width = std::max(across * panel_width, 2 * panel_width);
  const Legend legend = draw_legend(table, width);
  const int height = legend.height + down * panel_height;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<title>{2}</title>\n<desc>{3}</desc>\n"
      "<clipPath id=\"plot\"><rect width=\"{4}\" height=\"{5}\"/></clipPath>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height, html_escape(table.name), html_escape(table.caption), plot_width, plot_height);
  svg += legend.svg;
  for (int n = 0; n < static_cast<int>(panels.size()); ++n) {
    const auto& [title, panel] = panels[static_cast<std::size_t>(n)];
    svg += fmt::format("<g transform=\"translate({} {})\">\n", left + n % across * panel_width,
                       legend.height + top + n / across * panel_height);
    svg += label(0.5 * plot_width, -10, title, "text-anchor=\"middle\" font-weight=\"bold\"");
    svg += draw_panel(table, panel, x, y) + "</g>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace myowave::apps
