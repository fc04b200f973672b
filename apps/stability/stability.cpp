#include "apps/stability/stability.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/base/file_io.hpp"
#include "apps/draw/map_picture.hpp"
#include "apps/input/did_you_mean.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// Stays on one line of a terminal; elsewhere silent until the map is done.
class MapProgressLine {
 public:
  explicit MapProgressLine(std::string_view name) : name_(name), terminal_(isatty(STDERR_FILENO) == 1) {}
  void show(double part) const {
    if (terminal_) fmt::print(stderr, "\r\x1b[K{}: {:.0f} %", name_, 100 * part);
  }
  void end(std::size_t runs) const {
    const std::chrono::duration<double> spent = Clock::now() - start_;
    fmt::print(stderr, "{}{}: {} runs in {:.1f} s\n", terminal_ ? "\r\x1b[K" : "", name_, runs,
               spent.count());
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::string_view name_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
};

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw solver::InputError(
        fmt::format("cannot make the result folder {}: {}", folder.string(), error.message()));
  // What an earlier call may have left. Nothing else in the folder is touched.
  fs::remove(folder / "stability.json", error);
  for (const auto& map : solver::stability_maps())
    for (const char* ending : {".csv", ".svg"}) fs::remove(folder / (std::string(map.name) + ending), error);
}

std::string csv_text(const solver::MapCell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.10g}", *number);
  const auto* text = std::get_if<std::string>(&cell);
  return text ? fmt::format("\"{}\"", *text) : "";
}

std::size_t not_handled(const solver::MapTable& table) {
  return static_cast<std::size_t>(
      std::ranges::count_if(table.rows, [](const solver::MapRow& row) { return !row.handled; }));
}

json outcome_counts(const solver::MapTable& table) {
  json counts = json::object();
  for (std::size_t outcome = 0; outcome < table.outcomes.size(); ++outcome)
    counts[table.outcomes[outcome]] = std::ranges::count(table.rows, outcome, &solver::MapRow::outcome);
  return counts;
}

void print_map(const solver::MapTable& table) {
  fmt::print("{}: {} runs", table.name, table.rows.size());
  const json counts = outcome_counts(table);
  for (const auto& [outcome, count] : counts.items()) fmt::print(", {} {}", count.get<int>(), outcome);
  fmt::print("; not handled: {}\n", not_handled(table));
  for (const auto& line : table.findings) fmt::print("{}\n", line);
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

std::vector<solver::StabilityMap> choose_maps(const std::string& name) {
  const auto& maps = solver::stability_maps();
  if (name.empty()) return maps;
  const auto found = std::ranges::find(maps, name, &solver::StabilityMap::name);
  if (found != maps.end()) return {*found};
  std::vector<std::string_view> names;
  std::string all;
  for (const auto& map : maps) {
    names.push_back(map.name);
    all += fmt::format("{}{}", all.empty() ? "" : ", ", map.name);
  }
  const std::string meant = did_you_mean(name, names);
  throw solver::InputError(fmt::format("there is no map \"{}\"{}; maps: {}", name, hint(meant), all));
}

std::string map_csv(const solver::MapTable& table) {
  std::string text;
  for (const auto& column : table.columns)
    text += column.unit.empty() ? column.name + ',' : fmt::format("{} [{}],", column.name, column.unit);
  text += "outcome,handled\n";
  for (const auto& row : table.rows) {
    for (const auto& cell : row.cells) text += csv_text(cell) + ',';
    text += fmt::format("{},{}\n", csv_text(table.outcomes[row.outcome]), row.handled ? "yes" : "no");
  }
  return text;
}

json stability_json(std::span<const solver::MapTable> tables) {
  std::size_t tried = 0, missed = 0;
  json maps = json::array();
  for (const auto& table : tables) {
    tried += table.rows.size();
    missed += not_handled(table);
    maps.push_back({{"name", table.name},
                    {"caption", table.caption},
                    {"tried", table.rows.size()},
                    {"not_handled", not_handled(table)},
                    {"outcomes", outcome_counts(table)}});
  }
  return {{"tried", tried}, {"not_handled", missed}, {"maps", std::move(maps)}};
}

void write_maps(const std::vector<solver::StabilityMap>& maps, const fs::path& folder) {
  make_folder(folder);
  std::vector<solver::MapTable> tables;
  for (const auto& map : maps) {
    const MapProgressLine line(map.name);
    tables.push_back(map.make([&](double part) { line.show(part); }));
    const solver::MapTable& table = tables.back();
    line.end(table.rows.size());
    replace_file(folder / (table.name + ".csv"), map_csv(table));
    if (table.view) replace_file(folder / (table.name + ".svg"), map_svg(table));
    replace_file(folder / "stability.json", stability_json(tables).dump(2) + '\n');
    print_map(table);
  }
  const json all = stability_json(tables);
  fmt::print("{} runs tried, {} not handled; results in {}\n", all["tried"].get<int>(),
             all["not_handled"].get<int>(), folder.string());
  if (all["not_handled"].get<int>() > 0)
    throw solver::NumericalFailure(
        fmt::format("{} of {} runs returned a wrong result without an error or a warning: handled = no in "
                    "the tables of {}",
                    all["not_handled"].get<int>(), all["tried"].get<int>(), folder.string()));
}

}  // namespace myowave::apps
