#include "apps/sweep/sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

struct Column {
  const char* name;
  const char* place;  // in a record
};

// Columns that start with wall or cell_steps depend on the machine and its load. All others are bitwise
// identical on every machine with the same program.
constexpr std::array columns_of_records{
    Column{"outcome", "/outcome"},
    Column{"breakup_tu", "/observables/breakup_tu"},
    Column{"death_tu", "/observables/death_tu"},
    Column{"t_tu", "/t"},
    Column{"period_mean_tu", "/observables/period/mean"},
    Column{"period_sd_tu", "/observables/period/sd"},
    Column{"period_n", "/observables/period/n"},
    Column{"apd_mean_tu", "/observables/apd/mean"},
    Column{"apd_sd_tu", "/observables/apd/sd"},
    Column{"apd_n", "/observables/apd/n"},
    Column{"apd90_mean_tu", "/observables/apd90/mean"},
    Column{"apd90_sd_tu", "/observables/apd90/sd"},
    Column{"apd90_n", "/observables/apd90/n"},
    Column{"tips_mean", "/observables/tips/mean"},
    Column{"tips_sd", "/observables/tips/sd"},
    Column{"tips_n", "/observables/tips/n"},
    Column{"tips_correlation_tu", "/observables/tips/correlation_tu"},
    Column{"tips_standard_error", "/observables/tips/standard_error"},
    Column{"trajectories_n", "/observables/trajectories/n"},
    Column{"core_x", "/observables/core/x"},
    Column{"core_y", "/observables/core/y"},
    Column{"core_radius", "/observables/core/radius"},
    Column{"core_rotations", "/observables/core/rotations"},
    Column{"core_drift_speed", "/observables/core/drift_speed"},
    Column{"core_drift_direction", "/observables/core/drift_direction"},
    Column{"core_boundary_tu", "/observables/core/boundary_tu"},
    Column{"conduction_velocity_median", "/observables/conduction_velocity/median"},
    Column{"conduction_velocity_lower_quartile", "/observables/conduction_velocity/lower_quartile"},
    Column{"conduction_velocity_upper_quartile", "/observables/conduction_velocity/upper_quartile"},
    Column{"area_min", "/observables/area/min"},
    Column{"area_max", "/observables/area/max"},
    Column{"shortening_max", "/observables/shortening/max"},
    Column{"shortening_at_tu", "/observables/shortening/t"},
    Column{"steps", "/steps"},
    Column{"newton_iterations", "/mechanics/newton_iterations"},
    Column{"failure", "/failure"},
    Column{"wall_s", "/cost/wall_s"},
    Column{"wall_precondition_s", "/cost/precondition_s"},
    Column{"cell_steps_per_s", "/cost/cell_steps_per_s"},
};

// "/observables/period/mean" is of "period".
bool is_selected(const Column& column, const std::vector<std::string>& observables) {
  constexpr std::string_view before = "/observables/";
  std::string_view place = column.place;
  if (!place.starts_with(before)) return true;
  place.remove_prefix(before.size());
  return std::ranges::find(observables, place.substr(0, place.find('/'))) != observables.end();
}

json cell(const nlohmann::ordered_json& record, const char* place) {
  const nlohmann::ordered_json::json_pointer at(place);
  return record.contains(at) ? record[at] : json();
}

std::string text_of(const json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string csv_cell(const json& value) {
  std::string text = text_of(value);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + '"';
}

std::string short_text(const json& value) {
  constexpr std::size_t longest = 40;
  std::string text = value.is_number_float() ? fmt::format("{:.6g}", value.get<double>()) : text_of(value);
  if (text.size() > longest) text = text.substr(0, longest - 3) + "...";
  return text;
}

}  // namespace

std::size_t SweepTable::column(std::string_view name) const {
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end()) throw std::out_of_range(fmt::format("there is no column {}", name));
  return std::size_t(found - columns.begin());
}

SweepTable read_table(const std::filesystem::path& path) {
  const SweepFolder folder(path);
  SweepTable table{.plan = folder.plan(), .columns = {}, .cells = {}, .runs = {}, .refused = {}};
  Records records = read_records(path);
  table.refused = std::move(records.refused);
  for (const auto& axis : table.plan.axes) table.columns.push_back(axis.key);
  std::vector<Column> selected;
  for (const Column& column : columns_of_records)
    if (is_selected(column, table.plan.observables)) selected.push_back(column);
  for (const Column& column : selected) table.columns.emplace_back(column.name);
  for (std::size_t n = 0; n < table.plan.runs.size(); ++n) {
    const auto& run = table.plan.runs[n];
    const auto record = records.by_id.find(run.id);
    if (record == records.by_id.end()) {
      ++table.missing;
      continue;
    }
    table.failed += failed(record->second);
    table.other_revision += !of_this_revision(record->second);
    std::vector<json> row;
    for (std::size_t axis = 0; axis < run.at.size(); ++axis)
      row.push_back(table.plan.axes[axis].values[run.at[axis]]);
    for (const Column& column : selected) row.push_back(cell(record->second, column.place));
    table.cells.push_back(std::move(row));
    table.runs.push_back(n);
  }
  return table;
}

std::string table_csv(const SweepTable& table) {
  std::string text;
  const auto add_line = [&](const auto& cells) {
    const char* comma = "";
    for (const auto& cell : cells) {
      text += std::exchange(comma, ",");
      text += csv_cell(cell);
    }
    text += '\n';
  };
  add_line(table.columns);
  for (const auto& row : table.cells) add_line(row);
  return text;
}

std::string table_json(const SweepTable& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& cells : table.cells) {
    nlohmann::ordered_json row = nlohmann::ordered_json::object();
    for (std::size_t n = 0; n < cells.size(); ++n) row[table.columns[n]] = cells[n];
    rows.push_back(std::move(row));
  }
  return nlohmann::ordered_json({{"columns", table.columns},
                                 {"rows", std::move(rows)},
                                 {"missing", table.missing},
                                 {"failed", table.failed}})
             .dump(1) +
         '\n';
}

std::string table_text(const SweepTable& table) {
  std::vector<std::vector<std::string>> columns;
  for (std::size_t n = 0; n < table.columns.size(); ++n) {
    std::vector<std::string> column{table.columns[n]};
    for (const auto& row : table.cells) column.push_back(short_text(row[n]));
    const bool some = std::ranges::any_of(column.begin() + 1, column.end(),
                                          [](const std::string& text) { return !text.empty(); });
    if (some || n < table.plan.axes.size()) columns.push_back(std::move(column));
  }
  std::string text;
  for (std::size_t row = 0; row <= table.cells.size(); ++row) {
    std::string line;
    for (const auto& column : columns) {
      const std::size_t width = std::ranges::max(column, {}, &std::string::size).size();
      line += fmt::format("{}{:<{}}", line.empty() ? "" : "  ", column[row], width);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

}  // namespace myowave::apps
