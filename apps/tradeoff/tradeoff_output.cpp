#include "apps/tradeoff/tradeoff_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <system_error>
#include <utility>

#include "apps/base/file_io.hpp"
#include "apps/base/page.hpp"
#include "apps/draw/figure.hpp"
#include "apps/input/presets.hpp"
#include "apps/input/schema.hpp"
#include "apps/results/manifest.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;
using Fronts = std::map<std::string, std::vector<bool>, std::less<>>;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr const char* below_note = "* smaller than its uncertainty";

// What the reference has; an event that it lacks only if some setting has it.
std::vector<const Observable*> compared(const Study& study) {
  std::vector<const Observable*> names;
  if (!study.reference) return names;
  for (const Observable& one : observables()) {
    const auto found = study.reference->values.find(one.name);
    if (found == study.reference->values.end()) continue;
    const auto has_error = [&](const Trial& trial) { return trial.errors.contains(one.name); };
    if (one.kind != Observable::Kind::event || found->second.value ||
        std::ranges::any_of(study.trials, has_error))
      names.push_back(&one);
  }
  return names;
}

Error error_in(const Trial& trial, const Observable& one) {
  const auto found = trial.errors.find(one.name);
  return found == trial.errors.end() ? Error{unknown, unknown} : found->second;
}

double speed_up(const Study& study, const Trial& trial) {
  const auto paper = std::ranges::find(study.trials, "paper", [](const Trial& t) { return t.setting.name; });
  return paper == study.trials.end() ? unknown : median(paper->wall_s) / median(trial.wall_s);
}

std::vector<std::size_t> by_cost(const Study& study) {
  std::vector<std::size_t> order;
  for (std::size_t n = 0; n < study.trials.size(); ++n)
    if (!study.trials[n].wall_s.empty()) order.push_back(n);
  std::ranges::sort(order, {}, [&](std::size_t n) { return median(study.trials[n].wall_s); });
  return order;
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text) result += letter == '"' ? "\"\"" : std::string(1, letter);
  return result + '"';
}

std::string tradeoff_csv(const Study& study, const Fronts& fronts) {
  std::string text =
      "setting,overrides,repetitions,wall_median_s,wall_min_s,wall_max_s,speed_up,cell_steps_per_s";
  const auto names = compared(study);
  for (const auto* one : names)
    text += fmt::format(",{0}_error,{0}_uncertainty,{0}_on_front,{0}_below_uncertainty", one->name);
  text += ",trouble\n";
  for (std::size_t n = 0; n < study.trials.size(); ++n) {
    const Trial& trial = study.trials[n];
    const auto& wall = trial.wall_s;
    text += fmt::format("{},{},{},{},{},{},{},{}", quoted(trial.setting.name),
                        quoted(fmt::format("{}", fmt::join(trial.setting.overrides, " "))), wall.size(),
                        cell(median(wall)), cell(wall.empty() ? unknown : *std::ranges::min_element(wall)),
                        cell(wall.empty() ? unknown : *std::ranges::max_element(wall)),
                        cell(speed_up(study, trial)), cell(median(trial.cell_steps_per_s)));
    for (const auto* one : names) {
      const Error error = error_in(trial, *one);
      text += std::isnan(error.value)
                  ? ",,,,"
                  : fmt::format(",{},{},{},{}", std::isinf(error.value) ? "inf" : cell(error.value),
                                cell(error.uncertainty), fronts.find(one->name)->second[n] ? 1 : 0,
                                error.is_below() ? 1 : 0);
    }
    text += fmt::format(",{}\n", quoted(trial.trouble));
  }
  return text;
}

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json numbers(const std::vector<double>& values) {
  json result = json::array();
  for (const double value : values) result.push_back(number(value));
  return result;
}

json text_or_null(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

json reference_json(const Study& study) {
  json runs = json::array();
  for (const auto& run : study.reference_runs)
    runs.push_back({{"k", run.k},
                    {"overrides", run.overrides},
                    {"wall_s", run.wall_s},
                    {"trouble", text_or_null(run.trouble)}});
  json values = json::object();
  for (const auto* one : compared(study)) {
    const ReferenceValue& value = study.reference->values.find(one->name)->second;
    values[std::string(one->name)] = {{"title", one->title},
                                      {"unit_of_error", one->unit},
                                      {"levels", numbers(value.levels)},
                                      {"value", number(value.value.value_or(unknown))},
                                      {"order", number(value.order.value_or(unknown))},
                                      {"uncertainty", number(value.uncertainty)},
                                      {"how", value.how}};
  }
  return {{"runs", std::move(runs)},
          {"levels", study.reference ? study.reference->levels : std::vector<int>()},
          {"chaotic", study.reference && study.reference->chaotic},
          {"values", std::move(values)}};
}

json trial_json(const Study& study, std::size_t n, const Fronts& fronts) {
  const Trial& trial = study.trials[n];
  json errors = json::object();
  for (const auto* one : compared(study)) {
    const Error error = error_in(trial, *one);
    if (std::isnan(error.value)) continue;
    errors[std::string(one->name)] = {{"error", number(error.value)},
                                      {"uncertainty", number(error.uncertainty)},
                                      {"on_front", bool(fronts.find(one->name)->second[n])},
                                      {"below_uncertainty", error.is_below()}};
  }
  json measured = json::array();
  for (const Measures& run : trial.runs) measured.push_back(run.numbers);
  return {{"name", trial.setting.name},
          {"overrides", trial.setting.overrides},
          {"wall_s", numbers(trial.wall_s)},
          {"wall_median_s", number(median(trial.wall_s))},
          {"speed_up", number(speed_up(study, trial))},
          {"cell_steps_per_s", number(median(trial.cell_steps_per_s))},
          {"measured", std::move(measured)},
          {"errors", std::move(errors)},
          {"trouble", text_or_null(trial.trouble)}};
}

json tradeoff_json(const Study& study, const Fronts& fronts) {
  json settings = json::array();
  for (std::size_t n = 0; n < study.trials.size(); ++n) settings.push_back(trial_json(study, n, fronts));
  return {{"command", study.command},
          {"stopped", text_or_null(study.stopped)},
          {"manifest", manifest_json(effective_configuration(study.own))},
          {"reference", reference_json(study)},
          {"settings", std::move(settings)}};
}

// Cost against one error, both logarithmic: presets by name, all others, and the front.
Figure error_figure(const Study& study, const Observable& one, const std::vector<bool>& front) {
  Series line{.name = "front", .colour = 6},
      others{.name = "other settings", .mark = Mark::points, .colour = 5};
  std::vector<Series> of_presets;
  for (const std::size_t n : by_cost(study)) {
    const Trial& trial = study.trials[n];
    const double cost = median(trial.wall_s), error = error_in(trial, one).value;
    if (!(error > 0) || std::isinf(error)) continue;
    const auto add_to = [&](Series& series) { series.x.push_back(cost), series.y.push_back(error); };
    if (front[n]) add_to(line);
    const Preset* const preset = find_preset(trial.setting.name);
    if (preset == nullptr) {
      add_to(others);
      continue;
    }
    of_presets.push_back({.name = trial.setting.name,
                          .mark = Mark::points,
                          .colour = static_cast<int>(preset - presets().data())});
    add_to(of_presets.back());
  }
  Plot plot{.title = std::string(one.title),
            .x = {.label = "time of a run", .unit = "s", .logarithmic = true},
            .y = {.label = "error", .unit = std::string(one.unit), .logarithmic = true},
            .series = {std::move(line), std::move(others)}};
  plot.series.insert(plot.series.end(), of_presets.begin(), of_presets.end());
  std::erase_if(plot.series, [](const Series& series) { return series.x.empty(); });
  const double uncertainty = study.reference->values.find(one.name)->second.uncertainty;
  if (uncertainty > 0) plot.guides = {uncertainty};
  return {.panels = {std::move(plot)}};
}

std::string figure_name(const Observable& one) { return fmt::format("error_{}", one.name); }

// "0.12*": smaller than its uncertainty, which a chaotic scene's errors show: "3.1 +- 2.4". An event that the
// setting or the reference lacks has no distance.
std::string error_text(const Study& study, const Trial& trial, const Observable& one) {
  const Error error = error_in(trial, one);
  if (std::isnan(error.value)) return "-";
  if (std::isinf(error.value))
    return study.reference->values.find(one.name)->second.value ? "does not occur" : "occurs";
  std::string text = fmt::format("{:.3g}", error.value);
  if (study.reference->chaotic && std::isfinite(error.uncertainty))
    text += fmt::format(" +- {:.2g}", error.uncertainty);
  return text + (error.is_below() ? "*" : "");
}

std::string settings_html(const Study& study, const Fronts& fronts) {
  const auto names = compared(study);
  std::string html =
      "<div "
      "class=\"table\"><table><thead><tr><th>setting</th><th>s</th><th>speed-up</th><th>Mcell-steps/s</th>";
  for (const auto* one : names) html += fmt::format("<th>{} ({})</th>", one->title, one->unit);
  html += "</tr></thead><tbody>\n";
  for (const std::size_t n : by_cost(study)) {
    const Trial& trial = study.trials[n];
    html += fmt::format("<tr><th>{}</th><td>{:.3g}</td><td>{:.2f}</td><td>{:.1f}</td>",
                        html_escape(trial.setting.name), median(trial.wall_s), speed_up(study, trial),
                        median(trial.cell_steps_per_s) / 1e6);
    for (const auto* one : names) {
      const bool best = fronts.find(one->name)->second[n];
      html += fmt::format("<td>{}{}{}</td>", best ? "<b>" : "", error_text(study, trial, *one),
                          best ? "</b>" : "");
    }
    html += "</tr>\n";
  }
  return html + fmt::format(
                    "</tbody></table></div>\n<p class=\"faint\">Bold: no other setting is both as fast and "
                    "as close. {}.</p>\n",
                    below_note);
}

std::string plots_html(const Study& study, const fs::path& folder) {
  std::string html = "<div class=\"plots\">\n";
  for (const auto* one : compared(study))
    html += fmt::format(
        "<figure><img class=\"plot\" alt=\"{0}\" src=\"{1}\"><figcaption>{0}. Dashed: the uncertainty of the "
        "reference. <a href=\"{2}.svg\">{2}.svg</a></figcaption></figure>\n",
        html_escape(one->title), data_uri(folder / (figure_name(*one) + ".png")), figure_name(*one));
  return html + "</div>\n";
}

std::string reference_html(const Study& study) {
  std::string html;
  for (const auto& run : study.reference_runs)
    html += fmt::format("<li><code>{}</code>: {}</li>\n",
                        html_escape(fmt::format("{}", fmt::join(run.overrides, " "))),
                        run.trouble.empty() ? fmt::format("{:.3g} s", run.wall_s) : html_escape(run.trouble));
  html = fmt::format("<div class=\"scroll\"><ul>\n{}</ul></div>\n", html);
  if (!study.reference) return html + "<p class=\"warning\">No run of the reference reached its end.</p>\n";
  if (study.reference->chaotic)
    html += fmt::format(
        "<p class=\"note\">V of the two finest grids differs by more than {} % at the end: the scene is "
        "chaotic. Means are compared with those of several starts; fields, tips and curves are not "
        "compared.</p>\n",
        chaotic_difference);
  html +=
      "<div class=\"table\"><table><thead><tr><th>what</th><th>grids, coarse to fine</th><th>reference</th>"
      "<th>order</th><th>uncertainty</th><th>how</th></tr></thead><tbody>\n";
  for (const auto* one : compared(study)) {
    const ReferenceValue& value = study.reference->values.find(one->name)->second;
    html += fmt::format(
        "<tr><th>{}</th><td>{:.6g}</td><td>{}</td><td>{}</td><td>{} {}</td><td>{}</td></tr>\n", one->title,
        fmt::join(value.levels, ", "), value.value ? fmt::format("{:.6g}", *value.value) : "the field itself",
        value.order ? fmt::format("{:.2f}", *value.order) : "none",
        std::isfinite(value.uncertainty) ? fmt::format("{:.2g}", value.uncertainty) : "unknown", one->unit,
        value.how);
  }
  return html +
         "</tbody></table></div>\n<p class=\"faint\">For curves, fields and tips, the numbers of the grids "
         "are "
         "distances between one grid and the next finer one.</p>\n";
}

std::string troubles_html(const Study& study) {
  std::string html;
  for (const Trial& trial : study.trials)
    if (!trial.trouble.empty())
      html += fmt::format("<li>{}: {}</li>\n", html_escape(trial.setting.name), html_escape(trial.trouble));
  return html.empty() ? "" : fmt::format("<h2>Not run to the end</h2>\n<ul>\n{}</ul>\n", html);
}

std::string index_html(const Study& study, const Fronts& fronts, const fs::path& folder) {
  const std::string title = fmt::format("{}: cost against error", study.own.name);
  std::string body = fmt::format("<h1>{}</h1>\n<div class=\"scroll\"><code>{}</code></div>\n",
                                 html_escape(title), html_escape(study.command));
  if (!study.stopped.empty())
    body += fmt::format("<p class=\"warning\">{}</p>\n", html_escape(study.stopped));
  body += "<h2>Settings</h2>\n" + settings_html(study, fronts) + plots_html(study, folder) +
          "<h2>Reference</h2>\n" + reference_html(study) + troubles_html(study) +
          "<p>Files: <a href=\"tradeoff.csv\">tradeoff.csv</a>, <a "
          "href=\"tradeoff.json\">tradeoff.json</a></p>\n";
  return html_page(title, body);
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return unknown;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

Fronts fronts_of(const Study& study) {
  Fronts fronts;
  std::vector<double> cost;
  for (const Trial& trial : study.trials) cost.push_back(median(trial.wall_s));
  for (const auto* one : compared(study)) {
    std::vector<double> error;
    for (const Trial& trial : study.trials) {
      const Error own = error_in(trial, *one);
      error.push_back(own.is_below() ? own.uncertainty : own.value);
    }
    fronts.emplace(one->name, pareto_front(cost, error));
  }
  return fronts;
}

void remove_tradeoff(const fs::path& folder) {
  std::error_code ignored;
  for (const char* name : {"tradeoff.csv", "tradeoff.json", "index.html", "target.toml"})
    fs::remove(folder / name, ignored);
  for (const Observable& one : observables())
    for (const char* ending : {".png", ".svg"}) fs::remove(folder / (figure_name(one) + ending), ignored);
}

void write_tradeoff(const Study& study, const fs::path& folder) {
  const Fronts fronts = fronts_of(study);
  replace_file(folder / "tradeoff.csv", tradeoff_csv(study, fronts));
  replace_file(folder / "tradeoff.json", tradeoff_json(study, fronts).dump(2) + '\n');
  for (const auto* one : compared(study))
    write_figure(error_figure(study, *one, fronts.find(one->name)->second), folder / figure_name(*one));
  replace_file(folder / "index.html", index_html(study, fronts, folder));
}

void print_tradeoff(const Study& study) {
  const auto names = compared(study);
  const auto order = by_cost(study);
  std::size_t widest = 7;
  for (const std::size_t n : order) widest = std::max(widest, study.trials[n].setting.name.size());
  fmt::print("{:<{}}  {:>9}  {:>8}", "setting", widest, "s", "speed-up");
  for (const auto* one : names) fmt::print("  {:>11}", one->name);
  fmt::print("\n");
  for (const std::size_t n : order) {
    const Trial& trial = study.trials[n];
    fmt::print("{:<{}}  {:>9.3g}  {:>8.2f}", trial.setting.name, widest, median(trial.wall_s),
               speed_up(study, trial));
    for (const auto* one : names) fmt::print("  {:>11}", error_text(study, trial, *one));
    fmt::print("\n");
  }
  if (!names.empty()) {
    std::vector<std::string> units;
    for (const auto* one : names) units.push_back(fmt::format("{} in {}", one->name, one->unit));
    fmt::print("errors: {}; {}\n", fmt::join(units, ", "), below_note);
  }
  for (const Trial& trial : study.trials)
    if (!trial.trouble.empty()) fmt::print("{}: {}\n", trial.setting.name, trial.trouble);
  if (!study.stopped.empty()) fmt::print("{}\n", study.stopped);
  std::fflush(stdout);
}

}  // namespace myowave::apps
