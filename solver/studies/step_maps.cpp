#include "solver/studies/step_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "solver/base/denormals.hpp"

namespace myowave::solver {
namespace {

constexpr double paper_dx = 0.6;     // length units
constexpr double sheet_length = 36;  // of the deformed sheet, length units: a spiral turns in it
constexpr double front_length = 3;   // likewise
constexpr int cells_per_element = 10;

const char* name_of(const StepTrial& trial) {
  switch (trial.form) {
    case MetricForm::conservative:
      return "conservative";
    case MetricForm::expanded:
      return "expanded";
    case MetricForm::none:
      break;
  }
  return "rigid";
}

const char* precision_of(const StepTrial& trial) {
  return trial.precision == Precision::float32 ? "float32" : "float64";
}

// The trials of one sheet by dt / bound.
using Line = std::map<double, StepReport>;

Line try_line(const StepTrial& trial, double bound) {
  constexpr std::array coarse{0.4, 0.6, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7};
  constexpr double finest = 0.005;
  Line line;
  for (const double ratio : coarse) line[ratio] = try_steps(trial, ratio * bound);
  for (auto low = line.begin(); std::next(low) != line.end();) {
    const auto high = std::next(low);
    if (low->second.outcome() == high->second.outcome() || high->first - low->first < 1.5 * finest) {
      low = high;
    } else {
      const double middle = 0.5 * (low->first + high->first);
      line[middle] = try_steps(trial, middle * bound);
    }
  }
  return line;
}

void add_rows(const DeformedSheet& sheet, const StabilityBounds& bounds, const Line& line, MapTable& table) {
  for (const auto& [ratio, report] : line) {
    const bool refused = ratio > 1;
    const auto seen = [&](double value) { return report.blown_up ? MapCell{} : MapCell{value}; };
    table.rows.push_back(
        {{name_of(sheet.trial), precision_of(sheet.trial), sheet.value, bounds.max_trace_inverse_C,
          bounds.excited, bounds.at_rest, ratio * bounds.excited, seen(report.noise), seen(report.min_V),
          seen(report.max_V), std::string(refused ? "refuses" : "admits"),
          std::string(report.told ? "tells" : "silent")},
         static_cast<std::size_t>(report.outcome()),
         refused || report.told || report.outcome() == StepOutcome::right});
  }
}

// The smallest dt / bound that ends so.
std::optional<double> smallest(const Line& line, StepOutcome outcome) {
  const auto found =
      std::ranges::find_if(line, [=](const auto& run) { return run.second.outcome() == outcome; });
  return found == line.end() ? std::nullopt : std::optional(found->first);
}

// The smallest dt / bound that does not end right.
double smallest_not_right(const Line& line) {
  const auto found =
      std::ranges::find_if(line, [](const auto& run) { return run.second.outcome() != StepOutcome::right; });
  return found == line.end() ? std::numeric_limits<double>::infinity() : found->first;
}

std::string ratio_text(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.3f}", *ratio) : "-";
}

std::string finding(const DeformedSheet& sheet, const StabilityBounds& bounds, const Line& line) {
  const double first = smallest_not_right(line);
  std::optional<double> last_right;
  for (const auto& [ratio, report] : line)
    if (ratio < first) last_right = ratio;
  return fmt::format("| {:g} | {} | {} | {:.4g} | {} | {} | {} |", sheet.value, name_of(sheet.trial),
                     precision_of(sheet.trial), bounds.excited, ratio_text(last_right),
                     ratio_text(smallest(line, StepOutcome::wrong)),
                     ratio_text(smallest(line, StepOutcome::blown_up)));
}

// `sheet` in each form and precision, in the order of the panels of a map.
std::vector<DeformedSheet> in_all_variants(const std::vector<DeformedSheet>& sheets) {
  std::vector<DeformedSheet> all;
  for (const MetricForm form : {MetricForm::conservative, MetricForm::expanded})
    for (const Precision precision : {Precision::float64, Precision::float32})
      for (DeformedSheet sheet : sheets) {
        sheet.trial.form = form;
        sheet.trial.precision = precision;
        all.push_back(std::move(sheet));
      }
  return all;
}

// So many nodes that the deformed side is about `sheet_length`, whole elements.
int nodes_along(double stretch, double dx) {
  const double elements = sheet_length / (stretch * dx * cells_per_element);
  return cells_per_element * std::max(2, static_cast<int>(std::lround(elements))) + 1;
}

// A sheet whose element nodes lie at x(X1, X2).
template <class Placement>
DeformedSheet deformed(double value, const GridSettings& grid, int cells, double front_stretch,
                       const Placement& x) {
  DeformedSheet sheet{value, {}};
  sheet.trial.grid = grid;
  sheet.trial.cells_per_element = cells;
  sheet.trial.front_width = std::round(front_length / (front_stretch * grid.dx));
  const double h = cells * grid.dx;
  for (int I = 0; I <= (grid.rows - 1) / cells; ++I)
    for (int J = 0; J <= (grid.columns - 1) / cells; ++J)
      for (const double coordinate : x(J * h, I * h)) sheet.trial.nodes.push_back(coordinate);
  return sheet;
}

using Place = std::array<double, 2>;

constexpr std::array stretches{0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5};
const char* const what_is_run =
    " A broken front, 60 t.u. Right: V stays below 1 and the grid-scale noise below 0.05. Wrong: finite, but "
    "one does not. Blown up: V not finite or beyond 10. V starts with 1e-6 of alternating sign, to seed "
    "modes "
    "that grow.";

}  // namespace

MapTable map_of_steps(std::string name, const std::string& caption, MapColumn deformation,
                      const std::vector<DeformedSheet>& sheets, const MapProgress& progress) {
  const FlushDenormals flush;
  MapTable table{std::move(name), caption + what_is_run, {}, {"right", "wrong", "blown up"}, {}, {}, {}};
  table.view = MapView{{"form", "precision"},
                       deformation.name,
                       "dt",
                       {{"bound", "bound that a run keeps"}, {"bound_at_rest", "bound of the sheet at rest"}},
                       "bound"};
  table.columns = {{"form", ""},        {"precision", ""}, deformation,
                   {"max_tr_C^-1", ""}, {"bound", "t.u."}, {"bound_at_rest", "t.u."},
                   {"dt", "t.u."},      {"noise", ""},     {"min_V", ""},
                   {"max_V", ""},       {"guard", ""},     {"watch", ""}};
  std::map<std::string, std::pair<double, double>>
      nearest;  // of a form: dt / bound not right, at which value
  table.findings = {
      fmt::format("| {} | form | precision | bound (t.u.) | right up to | wrong from | blown up from |",
                  deformation.name),
      "|---|---|---|---|---|---|---|"};
  for (std::size_t n = 0; n < sheets.size(); ++n) {
    const StabilityBounds bounds = stability_bounds(sheets[n].trial);
    const Line line = try_line(sheets[n].trial, bounds.excited);
    add_rows(sheets[n], bounds, line, table);
    table.findings.push_back(finding(sheets[n], bounds, line));
    const double first = smallest_not_right(line);
    const auto [known, is_new] = nearest.try_emplace(name_of(sheets[n].trial), first, sheets[n].value);
    if (!is_new && first < known->second.first) known->second = {first, sheets[n].value};
    progress(static_cast<double>(n + 1) / static_cast<double>(sheets.size()));
  }
  table.findings.emplace_back();
  for (const auto& [form, at] : nearest)
    table.findings.push_back(
        fmt::format("{}: no run below {:.3f} of its bound fails; the first that does is at {} = {:g}", form,
                    at.first, deformation.name, at.second));
  return table;
}

MapTable make_dt_rigid(const MapProgress& progress) {
  std::vector<DeformedSheet> sheets;
  for (const Precision precision : {Precision::float64, Precision::float32})
    for (const double dx : {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
      const int n = nodes_along(1, dx);
      sheets.push_back(deformed(dx, {n, n, dx}, cells_per_element, 1, [](double X1, double X2) {
        return Place{X1, X2};
      }));
      sheets.back().trial.precision = precision;
    }
  return map_of_steps("dt_rigid", "dt against the node spacing of a rigid sheet.", {"dx", "length units"},
                      sheets, progress);
}

MapTable make_dt_stretch(const MapProgress& progress) {
  std::vector<DeformedSheet> sheets;
  for (const double stretch : stretches) {
    const int n = nodes_along(stretch, paper_dx);
    sheets.push_back(
        deformed(stretch, {n, n, paper_dx}, cells_per_element, stretch, [=](double X1, double X2) {
          return Place{stretch * X1, stretch * X2};
        }));
  }
  return map_of_steps("dt_stretch", "dt against the same stretch in both directions.", {"stretch", ""},
                      in_all_variants(sheets), progress);
}

MapTable make_dt_uniaxial(const MapProgress& progress) {
  std::vector<DeformedSheet> sheets;
  for (const double stretch : stretches)
    sheets.push_back(deformed(stretch, {nodes_along(1, paper_dx), nodes_along(stretch, paper_dx), paper_dx},
                              cells_per_element, stretch, [=](double X1, double X2) {
                                return Place{stretch * X1, X2};
                              }));
  return map_of_steps("dt_uniaxial", "dt against a stretch along X1 alone.", {"stretch", ""},
                      in_all_variants(sheets), progress);
}

MapTable make_dt_shear(const MapProgress& progress) {
  const int n = nodes_along(1, paper_dx);
  std::vector<DeformedSheet> sheets;
  for (int tenth = 0; tenth <= 15; tenth += 3) {
    const double shear = 0.1 * tenth;
    sheets.push_back(deformed(shear, {n, n, paper_dx}, cells_per_element, 1, [=](double X1, double X2) {
      return Place{X1 + shear * X2, X2};
    }));
  }
  return map_of_steps("dt_shear", "dt against a simple shear, x1 = X1 + shear X2.", {"shear", ""},
                      in_all_variants(sheets), progress);
}

MapTable make_dt_bilinear(const MapProgress& progress) {
  const int n = nodes_along(1, paper_dx);
  const double length = (n - 1) * paper_dx;
  std::vector<DeformedSheet> sheets;
  for (const double edge : {0.2, 0.3, 0.4, 0.6, 0.8, 1.0})
    sheets.push_back(deformed(edge, {n, n, paper_dx}, n - 1, 1, [=](double X1, double X2) {
      return Place{X1 * (1 - (1 - edge) * X2 / length), X2};
    }));
  return map_of_steps(
      "dt_bilinear",
      "dt against the length of the upper edge of a sheet that is one bilinear element, so that "
      "tr C^-1 varies in it.",
      {"edge", "of its length"}, in_all_variants(sheets), progress);
}

MapTable make_dt_crumpled(const MapProgress& progress) {
  const int n = nodes_along(1, paper_dx);
  const double h = cells_per_element * paper_dx;
  std::vector<DeformedSheet> sheets;
  for (const double moved : {0.0, 0.05, 0.1, 0.15, 0.2, 0.21, 0.22, 0.23})
    sheets.push_back(deformed(moved, {n, n, paper_dx}, cells_per_element, 1, [=](double X1, double X2) {
      const bool odd = std::lround((X1 + X2) / h) % 2 != 0;
      const double step = (odd ? moved : -moved) * h;
      return Place{X1 + step, X2 + step};
    }));
  return map_of_steps(
      "dt_crumpled",
      "dt against how far neighbouring element nodes are moved in opposite directions along the "
      "diagonal, so that F jumps between elements; the smallest J at a corner is 1 - 4 moved.",
      {"moved", "element edges"}, in_all_variants(sheets), progress);
}

}  // namespace myowave::solver
