#include "apps/sweep/sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "apps/results/observable_table.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

struct Column {
  std::string name;
  std::string place;  // in a record
};

void add_observables(std::vector<Column>& columns, const std::vector<std::string>& kept, bool outcome) {
  for (const ObservableRow& row : observable_table()) {
    const bool is_kept = std::ranges::find(kept, row.group()) != kept.end();
    if (is_kept && row.outcome == outcome && !row.column.empty())
      columns.push_back({std::string(row.column), fmt::format("/observables/{}", row.path)});
  }
}

// Columns that start with wall or cell_steps depend on the machine and its load. All others are bitwise
// identical on every machine with the same program.
std::vector<Column> columns_of_records(const std::vector<std::string>& kept) {
  std::vector<Column> columns{{"outcome", "/outcome"}};
  add_observables(columns, kept, true);
  columns.push_back({"t_tu", "/t"});
  add_observables(columns, kept, false);
  columns.insert(columns.end(), {{"steps", "/steps"},
                                 {"newton_iterations", "/mechanics/newton_iterations"},
                                 {"failure", "/failure"},
                                 {"wall_s", "/cost/wall_s"},
                                 {"wall_precondition_s", "/cost/precondition_s"},
                                 {"cell_steps_per_s", "/cost/cell_steps_per_s"}});
  return columns;
}

json cell(const nlohmann::ordered_json& record, const std::string& place) {
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
  if (text.size() > longest) text.replace(longest - 3, std::string::npos, "...");
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
  const std::vector<Column> columns = columns_of_records(table.plan.observables);
  for (const Column& column : columns) table.columns.push_back(column.name);
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
    for (const Column& column : columns) row.push_back(cell(record->second, column.place));
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
