#include "apps/report/report_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "apps/base/time_units.hpp"
#include "apps/results/observable_table.hpp"
#include "solver/analysis/statistics.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;
constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_plots = 12;  // of break-ups; more are no help

bool has_numbers(const StoredPlan::StoredAxis& axis) {
  return std::ranges::all_of(axis.values, [](const json& value) { return value.is_number(); });
}

bool is_seed(const StoredPlan::StoredAxis& axis) { return axis.key == "initial.seed"; }

std::string value_name(const std::string& key, const json& value) {
  if (key == "mechanics.on" && value.is_boolean()) return value.get<bool>() ? "contracting" : "rigid";
  if (key == "mechanics.contraction" && value.is_boolean())
    return value.get<bool>() ? "contracting" : "without contraction";
  if (value.is_string()) return value.get<std::string>();
  const auto dot = key.rfind('.');
  return fmt::format("{} = {}", dot == std::string::npos ? key : key.substr(dot + 1), value.dump());
}

// How the axes are shown: one along x, one by colour, the others a plot each.
struct Layout {
  std::optional<std::size_t> x, colour;
  std::vector<std::size_t> plots;
};

Layout layout_of(const StoredPlan& plan) {
  Layout layout;
  const auto& axes = plan.axes;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    if (!has_numbers(axes[n]) || is_seed(axes[n]) || (plan.pairs && plan.pairs->axis == n)) continue;
    if (!layout.x || axes[n].values.size() > axes[*layout.x].values.size()) layout.x = n;
  }
  if (plan.pairs) layout.colour = plan.pairs->axis;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    if (n == layout.x || n == layout.colour || is_seed(axes[n])) continue;
    if (!layout.colour)
      layout.colour = n;
    else
      layout.plots.push_back(n);
  }
  return layout;
}

class SweepView {
 public:
  explicit SweepView(const SweepTable& table) : table_(table), layout_(layout_of(table.plan)) {}

  const Layout& layout() const { return layout_; }

  // Of row n, the value on an axis.
  const json& value(std::size_t row, std::size_t axis) const { return table_.cells[row][axis]; }

  double number(std::size_t row, std::string_view column) const {
    const auto found = std::ranges::find(table_.columns, column);
    if (found == table_.columns.end()) return none;
    const json& cell = table_.cells[row][std::size_t(found - table_.columns.begin())];
    return cell.is_number() ? cell.get<double>() : none;
  }

  bool failed(std::size_t row) const { return table_.cells[row][table_.column("outcome")] == "failed"; }

  std::string words(std::size_t row, const std::vector<std::size_t>& axes) const {
    std::string text;
    for (const std::size_t axis : axes)
      text += (text.empty() ? "" : ", ") + value_name(table_.plan.axes[axis].key, value(row, axis));
    return text;
  }

  // Rows by what they have in common, in the order in which they come.
  std::vector<std::pair<std::string, std::vector<std::size_t>>> groups(
      const std::vector<std::size_t>& rows, const std::vector<std::size_t>& axes) const {
    std::vector<std::pair<std::string, std::vector<std::size_t>>> result;
    for (const std::size_t row : rows) {
      const std::string name = words(row, axes);
      auto found = std::ranges::find(result, name, [](const auto& group) { return group.first; });
      if (found == result.end()) found = result.insert(result.end(), {name, {}});
      found->second.push_back(row);
    }
    return result;
  }

  std::vector<std::size_t> rows() const {
    std::vector<std::size_t> all(table_.cells.size());
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = n;
    return all;
  }

  // Not before the end; one that died first never broke up.
  double at_least(std::size_t row) const {
    for (const char* column : {"breakup_tu", "death_tu", "t_tu"})
      if (const double t = number(row, column); std::isfinite(t)) return t;
    return none;
  }

  Axis x_axis() const { return {.label = table_.plan.axes[*layout_.x].key, .unit = ""}; }

  // Means over the rows that have the same x.
  Series curve(const std::string& name, const std::vector<std::size_t>& rows, std::string_view column,
               double factor) const {
    std::map<double, std::vector<double>> values;
    for (const std::size_t row : rows) {
      const double y = failed(row) ? none : number(row, column);
      auto& at = values[value(row, *layout_.x).get<double>()];
      if (std::isfinite(y)) at.push_back(factor * y);
    }
    Series series{.name = name, .mark = Mark::linked_points};
    bool spread = false;
    for (const auto& [x, ys] : values) {
      const auto mean = solver::mean_sd(ys);
      series.x.push_back(x);
      series.y.push_back(ys.empty() ? none : mean.mean);
      series.error.push_back(ys.size() > 1 ? mean.sd : 0);
      spread = spread || ys.size() > 1;
    }
    if (!spread) series.error.clear();
    return series;
  }

 private:
  const SweepTable& table_;
  Layout layout_;
};

// The break-up of each run, and the last time of those that stayed whole.
Plot breakup_plot(const SweepView& view, const std::string& title, const std::vector<std::size_t>& rows) {
  Plot plot{.title = title, .x = view.x_axis(), .y = {.label = "first break-up", .unit = "s", .min = 0.0}};
  const auto& colour = view.layout().colour;
  const auto groups = view.groups(rows, colour ? std::vector{*colour} : std::vector<std::size_t>{});
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const auto& [name, members] = groups[n];
    Series broke = view.curve(name.empty() ? "runs" : name, members, "breakup_tu", to_seconds(1));
    broke.colour = int(n);
    Series whole{.name = broke.name + ": none", .mark = Mark::rings, .colour = int(n)};
    for (const std::size_t row : members) {
      if (view.failed(row) || std::isfinite(view.number(row, "breakup_tu"))) continue;
      whole.x.push_back(view.value(row, *view.layout().x).get<double>());
      whole.y.push_back(to_seconds(view.at_least(row)));
    }
    plot.series.push_back(std::move(broke));
    if (!whole.x.empty()) plot.series.push_back(std::move(whole));
  }
  return plot;
}

// What the runs of a plot have in common, in words.
std::string start_name(const StoredPlan& plan, const Layout& layout, const std::string& words) {
  const bool is_start = layout.plots.size() == 1 && plan.axes[layout.plots[0]].key == "initial";
  return is_start ? "start " + words : words;
}

std::vector<NamedPlot> observable_plots(const SweepView& view) {
  std::vector<std::size_t> others = view.layout().plots;
  if (view.layout().colour) others.push_back(*view.layout().colour);
  std::vector<NamedPlot> plots;
  for (const ObservableRow& one : observable_table()) {
    if (one.curve.empty()) continue;
    const std::string label(one.curve);
    Plot plot{.title = label, .x = view.x_axis(), .y = {.label = label, .unit = std::string(one.unit.axis)}};
    int number = 0;  // a curve has one colour in all plots
    for (const auto& [name, rows] : view.groups(view.rows(), others)) {
      Series series = view.curve(name.empty() ? "runs" : name, rows, one.column, one.unit.factor);
      series.colour = number++;
      const bool any = std::ranges::any_of(series.y, [](double y) { return std::isfinite(y); });
      if (any) plot.series.push_back(std::move(series));
    }
    if (plot.series.empty() || plot.series.size() > 2 * palette.size()) continue;
    plots.push_back(
        {std::string(one.column), fmt::format("{} over the axes; a failed run has no mark.", label), plot});
  }
  return plots;
}

void add_pair(PairCount& count, const SweepView& view, std::size_t reference, std::size_t other) {
  if (view.failed(reference) || view.failed(other)) {
    ++count.missing;
    return;
  }
  const double first = view.number(reference, "breakup_tu"), second = view.number(other, "breakup_tu");
  const bool broke = std::isfinite(second);
  if (std::isfinite(first) && broke) count.delays.push_back(second - first);
  if (std::isfinite(first) && view.at_least(other) > first)
    ++(broke ? count.later : count.never);
  else if (broke && view.at_least(reference) > second)
    ++count.earlier;
  else
    ++count.undecided;
}

}  // namespace

std::vector<std::string> pair_names(const SweepTable& table) {
  const auto& pairs = *table.plan.pairs;
  const auto& axis = table.plan.axes[pairs.axis];
  return {value_name(axis.key, axis.values[pairs.reference]), value_name(axis.key, axis.values[pairs.other])};
}

std::vector<PairRow> pair_rows(const SweepTable& table) {
  if (!table.plan.pairs) return {};
  const SweepView view(table);
  const auto& pairs = *table.plan.pairs;
  std::vector<std::size_t> others;
  for (std::size_t axis = 0; axis < table.plan.axes.size(); ++axis)
    if (axis != pairs.axis) others.push_back(axis);
  std::vector<PairRow> rows;
  PairRow all{.what = "all", .count = {}};
  for (const auto& [what, members] : view.groups(view.rows(), view.layout().plots)) {
    PairRow row{.what = what, .count = {}};
    for (const auto& [name, pair] : view.groups(members, others)) {
      std::optional<std::size_t> reference, other;
      for (const std::size_t n : pair) {
        const std::size_t at = table.plan.runs[table.runs[n]].at[pairs.axis];
        (at == pairs.reference ? reference : other) = n;
      }
      for (PairCount* count : {&row.count, &all.count}) {
        if (reference && other)
          add_pair(*count, view, *reference, *other);
        else
          ++count->missing;
      }
    }
    if (!what.empty()) rows.push_back(std::move(row));
  }
  rows.push_back(std::move(all));
  return rows;
}

std::vector<NamedPlot> sweep_plots(const SweepTable& table) {
  const SweepView view(table);
  if (!view.layout().x || table.cells.empty()) return {};
  std::vector<NamedPlot> plots;
  const auto rows = view.rows();
  const bool any_end = std::ranges::any_of(rows, [&](std::size_t row) { return !view.failed(row); });
  const auto groups = view.groups(rows, view.layout().plots);
  for (std::size_t n = 0; any_end && n < std::min(groups.size(), most_plots); ++n) {
    const std::string title = start_name(table.plan, view.layout(), groups[n].first);
    plots.push_back(
        {groups.size() > 1 ? fmt::format("breakup_{}", n) : "breakup",
         fmt::format("First break-up{}. A ring is the end or the death of a run that did not break "
                     "up until then.",
                     title.empty() ? "" : ", " + title),
         breakup_plot(view, title.empty() ? "first break-up" : title, groups[n].second)});
  }
  for (auto& plot : observable_plots(view)) plots.push_back(std::move(plot));
  return plots;
}

}  // namespace myowave::apps
