#include "apps/draw/plot.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

json numbers(const std::vector<double>& values) {
  json result = json::array();
  for (const double value : values) result.push_back(number(value));
  return result;
}

json axis_json(const Axis& axis) {
  return {{"label", axis.label},
          {"unit", axis.unit},
          {"min", axis.min ? number(*axis.min) : json(nullptr)},
          {"max", axis.max ? number(*axis.max) : json(nullptr)}};
}

const char* mark_name(Mark mark) {
  switch (mark) {
    case Mark::line:
      return "line";
    case Mark::points:
      return "points";
    case Mark::rings:
      return "rings";
    case Mark::linked_points:
      return "linked_points";
    case Mark::steps:
      return "steps";
    case Mark::bars:
      return "bars";
  }
  return "line";
}

}  // namespace

Colour series_colour(const Series& series, std::size_t n) {
  const auto number = series.colour ? static_cast<std::size_t>(*series.colour) : n;
  return palette[number % palette.size()];
}

json plot_json(const Plot& plot) {
  json series = json::array();
  for (std::size_t n = 0; n < plot.series.size(); ++n) {
    const Series& one = plot.series[n];
    const Colour colour = series_colour(one, n);
    series.push_back({{"name", one.name},
                      {"x", numbers(one.x)},
                      {"y", numbers(one.y)},
                      {"mark", mark_name(one.mark)},
                      {"dashed", one.dashed},
                      {"colour", fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue)},
                      {"error", numbers(one.error)}});
  }
  return {{"title", plot.title},
          {"x", axis_json(plot.x)},
          {"y", axis_json(plot.y)},
          {"equal_scales", plot.equal_scales},
          {"guides", numbers(plot.guides)},
          {"series", std::move(series)}};
}

}  // namespace myowave::apps
