// The plots of a run and of a sweep.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "apps/report/report_run.hpp"
#include "apps/results/observable_table.hpp"

namespace myowave::apps {
namespace {

using nlohmann::json;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

std::string probe_name(const json& configuration, std::size_t n) {
  const json::json_pointer at(fmt::format("/output/probes/{}", n));
  if (!configuration.is_object() || !configuration.contains(at)) return fmt::format("probe {}", n);
  return fmt::format("row {}, column {}", configuration[at][0].dump(), configuration[at][1].dump());
}

Plot probe_plot(const CsvTable& table, const json& configuration, double s_per_tu,
                const std::string& quantity) {
  Plot plot;
  const auto t = scaled(table.numbers("t"), s_per_tu);
  for (std::size_t n = 0; table.has(fmt::format("{}{}", quantity, n)); ++n) {
    const auto values = table.numbers(fmt::format("{}{}", quantity, n));
    if (std::ranges::none_of(values, [](double value) { return std::isfinite(value); })) continue;
    plot.series.push_back({.name = probe_name(configuration, n), .x = t, .y = values});
  }
  return plot;
}

// Of each charge, a gap between two trajectories.
Plot tip_plot(const CsvTable& tips) {
  Plot plot{.title = "Tip trajectories",
            .x = {"X₁", "length units"},
            .y = {"X₂", "length units"},
            .equal_scales = true};
  const auto x = tips.numbers("x"), y = tips.numbers("y"), charge = tips.numbers("charge");
  const bool linked = tips.has("trajectory");
  const auto of = linked ? tips.numbers("trajectory") : std::vector<double>(x.size(), 0.0);
  for (const double sign : {1.0, -1.0}) {
    std::map<double, Series> paths;
    for (std::size_t n = 0; n < x.size(); ++n) {
      if (charge[n] != sign) continue;
      paths[of[n]].x.push_back(x[n]);
      paths[of[n]].y.push_back(y[n]);
    }
    Series all{.name = sign > 0 ? "counter-clockwise" : "clockwise",
               .mark = linked ? Mark::line : Mark::points,
               .colour = sign > 0 ? 0 : 1};
    for (const auto& [number, path] : paths) {
      if (!all.x.empty()) all.x.push_back(none), all.y.push_back(none);
      all.x.insert(all.x.end(), path.x.begin(), path.x.end());
      all.y.insert(all.y.end(), path.y.begin(), path.y.end());
    }
    if (!all.x.empty()) plot.series.push_back(std::move(all));
  }
  return plot;
}

// The number of tips at each time that has one.
CsvTable counted(const CsvTable& tips) {
  CsvTable table{.columns = {"t", "sources"}, .rows = {}};
  for (const auto& row : tips.rows) {
    const std::string& t = row[tips.index_of("t")];
    if (table.rows.empty() || table.rows.back()[0] != t) table.rows.push_back({t, "0"});
    table.rows.back()[1] = std::to_string(std::stoi(table.rows.back()[1]) + 1);
  }
  return table;
}

// One series a probe: `y` of its beats against `x`.
template <class X, class Y>
std::vector<Series> beat_series(const CsvTable& beats, const json& configuration, Mark mark, const X& x,
                                const Y& y) {
  std::map<double, std::vector<std::size_t>> of_probe;
  const auto probe = beats.numbers("probe");
  for (std::size_t n = 0; n < probe.size(); ++n) of_probe[probe[n]].push_back(n);
  std::vector<Series> series;
  for (const auto& [number, rows] : of_probe) {
    Series one{.name = probe_name(configuration, static_cast<std::size_t>(number)), .mark = mark};
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double at = x(rows, k), value = y(rows, k);
      if (!std::isfinite(at) || !std::isfinite(value)) continue;
      one.x.push_back(at);
      one.y.push_back(value);
    }
    if (!one.x.empty()) series.push_back(std::move(one));
  }
  return series;
}

using Rows = std::vector<std::size_t>;

// "tips" of "tips/mean", "core_radius" of "core/radius".
std::string file_name(const ObservableRow& row) {
  std::string name(row.path.ends_with("/mean") ? row.group() : row.path);
  std::ranges::replace(name, '/', '_');
  return name;
}

// The value of a run with its standard deviation, if it has one.
void add_point(Series& series, const ReportRun& run, const ObservableRow& row, double x) {
  const auto& summary = run.results().summary();
  const auto number = [&summary](std::string_view path) {
    const nlohmann::ordered_json::json_pointer at(fmt::format("/observables/{}", path));
    return summary.contains(at) && summary[at].is_number() ? summary[at].get<double>() : none;
  };
  const double value = number(row.path), sd = number(fmt::format("{}/sd", row.group()));
  if (!std::isfinite(value)) return;
  const double factor = row.unit.text == "t.u." ? run.ms_per_tu() : row.unit.factor;
  series.x.push_back(x);
  series.y.push_back(factor * value);
  series.error.push_back(row.path.ends_with("/mean") && std::isfinite(sd) ? factor * sd : 0);
}

}  // namespace

std::vector<NamedPlot> ReportRun::plots() const {
  std::vector<NamedPlot> plots;
  const double ms = ms_per_tu(), s = 1e-3 * ms;
  const json scene = configuration();
  const Axis time{"time", "s"};
  const auto add = [&](const char* name, const char* caption, Plot plot) {
    if (!plot.series.empty()) plots.push_back({name, caption, std::move(plot)});
  };
  if (!probes_.rows.empty()) {
    Plot V = probe_plot(probes_, scene, s, "V"), Ta = probe_plot(probes_, scene, s, "Ta");
    V.title = "Transmembrane potential at the probes", V.x = time, V.y = {"V", ""};
    Ta.title = "Active tension at the probes", Ta.x = time, Ta.y = {"Ta", "kPa"};
    add("probes_V", "Membrane potential: −80 mV + 100 mV · V.", V);
    add("probes_Ta", "", Ta);
  }
  if (!area_.rows.empty()) {
    const auto t = scaled(area_.numbers("t"), s);
    add("area", "Relative to the loaded sheet at rest.",
        {.title = "Area",
         .x = time,
         .y = {"area / area at rest", ""},
         .series = {{.name = "sheet", .x = t, .y = area_.numbers("area")},
                    {.name = "smallest element", .x = t, .y = area_.numbers("area_min")},
                    {.name = "largest element", .x = t, .y = area_.numbers("area_max")}}});
  }
  const bool sampled = !sources_.rows.empty();
  const CsvTable sources = sampled ? sources_ : counted(tips_);
  if (!sources.rows.empty()) {
    add("tips", sampled ? "" : "Times without a tip are not shown.",
        {.title = "Number of phase singularities",
         .x = time,
         .y = {"phase singularities", "", 0},
         .series = {{.name = "",
                     .x = scaled(sources.numbers("t"), s),
                     .y = sources.numbers("sources"),
                     .mark = Mark::steps}}});
  }
  if (!tips_.rows.empty()) add("trajectories", "In material coordinates.", tip_plot(tips_));
  if (!beats_.rows.empty()) {
    const auto upstroke = beats_.numbers("upstroke_tu"), period = beats_.numbers("period_tu");
    const auto apd90 = beats_.numbers("apd90_tu"), di = beats_.numbers("di_tu");
    add("periods", "From one upstroke to the next.",
        {.title = "Period at the probes",
         .x = time,
         .y = {"period", "ms"},
         .series = beat_series(
             beats_, scene, Mark::linked_points,
             [&](const Rows& rows, std::size_t k) { return s * upstroke[rows[k]]; },
             [&](const Rows& rows, std::size_t k) { return ms * period[rows[k]]; })});
    add("restitution", "Each action potential against the diastolic interval before it.",
        {.title = "Restitution",
         .x = {"diastolic interval", "ms"},
         .y = {"APD90", "ms"},
         .series = beat_series(
             beats_, scene, Mark::points,
             [&](const Rows& rows, std::size_t k) { return k > 0 ? ms * di[rows[k - 1]] : none; },
             [&](const Rows& rows, std::size_t k) { return ms * apd90[rows[k]]; })});
  }
  return plots;
}

std::vector<NamedPlot> sweep_plots(const std::vector<ReportRun>& runs) {
  std::set<std::string> names;
  std::vector<json> flat;
  for (const ReportRun& run : runs) {
    json scene = run.configuration();
    if (!scene.is_object() || !run.results().summary().is_object()) return {};
    scene.erase("output");
    flat.push_back(scene.flatten());
    for (const auto& [name, value] : flat.back().items()) names.insert(name);
  }
  std::string varied;
  for (const std::string& name : names) {
    const bool same = std::ranges::all_of(flat, [&](const json& one) {
      return one.contains(name) && flat[0].contains(name) && one[name] == flat[0][name];
    });
    if (same) continue;
    const bool number = std::ranges::all_of(
        flat, [&](const json& one) { return one.contains(name) && one[name].is_number(); });
    if (!varied.empty() || !number) return {};
    varied = name;
  }
  if (varied.empty()) return {};
  std::string key = varied.substr(1);
  std::ranges::replace(key, '/', '.');
  std::vector<NamedPlot> plots;
  for (const ObservableRow& row : observable_table()) {
    if (row.curve.empty()) continue;
    Series series{.name = "", .mark = Mark::points};
    for (std::size_t n = 0; n < runs.size(); ++n)
      add_point(series, runs[n], row, flat[n][varied].get<double>());
    if (series.x.size() < 2) continue;
    const bool spread = std::ranges::any_of(series.error, [](double sd) { return sd > 0; });
    if (!spread) series.error.clear();
    plots.push_back({"sweep_" + file_name(row),
                     spread ? "Mean and standard deviation of each run." : "",
                     {.title = fmt::format("{} against {}", row.curve, key),
                      .x = {key, ""},
                      .y = {std::string(row.curve), std::string(row.unit.axis)},
                      .series = {std::move(series)}}});
  }
  return plots;
}

}  // namespace myowave::apps
