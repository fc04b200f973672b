#include "apps/results/run_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>

#include "apps/base/hdf5_handle.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using solver::InputError;

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

double number(std::string_view cell) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

double attribute(hid_t file, const char* name, double otherwise) {
  if (H5Aexists(file, name) <= 0) return otherwise;
  const Hdf5Handle id(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, name);
  double value = otherwise;
  check_hdf5(H5Aread(id, H5T_NATIVE_DOUBLE, &value), name);
  return value;
}

}  // namespace

bool CsvTable::has(std::string_view column) const {
  return std::ranges::find(columns, column) != columns.end();
}

std::size_t CsvTable::index_of(std::string_view column) const {
  const auto found = std::ranges::find(columns, column);
  if (found == columns.end())
    throw std::out_of_range(
        fmt::format("there is no column {}; columns: {}", column, fmt::join(columns, ", ")));
  return static_cast<std::size_t>(found - columns.begin());
}

std::vector<double> CsvTable::numbers(std::string_view column) const {
  const std::size_t index = index_of(column);
  std::vector<double> values;
  for (const auto& row : rows) values.push_back(number(row[index]));
  return values;
}

CsvTable read_csv(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: no such file", path.string()));
  CsvTable table;
  std::string line;
  if (std::getline(file, line)) table.columns = split(line);
  while (std::getline(file, line)) {
    auto cells = split(line);
    // A row is whole where its line has ended.
    if (!file.eof() && cells.size() == table.columns.size())
      table.rows.push_back(std::move(cells));
    else
      ++table.left_out;
  }
  return table;
}

RunResults::RunResults(fs::path folder, Unfinished unfinished) : folder_(std::move(folder)) {
  const fs::path path = folder_ / "summary.json";
  std::ifstream file(path);
  if (!file && unfinished == Unfinished::accept) return;
  if (!file)
    throw InputError(
        fmt::format("{}: there is no summary.json: not the folder of a finished run", folder_.string()));
  try {
    summary_ = nlohmann::ordered_json::parse(file);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

std::vector<double> RunResults::frame_times() const {
  const fs::path path = folder_ / "fields.h5";
  if (!fs::exists(path)) return {};
  const Hdf5Handle file = open_hdf5(path);
  const StoredDataset time = open_dataset(file, "time");
  std::vector<double> times(time.size[0]);
  if (!times.empty())
    check_hdf5(H5Dread(time.id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times.data()),
               path.string());
  return times;
}

StoredFrame RunResults::frame(std::size_t n) const {
  const fs::path path = folder_ / "fields.h5";
  if (!fs::exists(path)) throw InputError(fmt::format("{}: no such file", path.string()));
  const Hdf5Handle file = open_hdf5(path);
  const StoredDataset time = open_dataset(file, "time"), V = open_dataset(file, "V");
  if (n >= time.size[0])
    throw InputError(fmt::format("{}: there is no frame {}, only {}", path.string(), n, time.size[0]));
  StoredFrame frame;
  frame.t = read_frame(time, n)[0];
  frame.shape = {int(V.size[1]), int(V.size[2]), int(attribute(file, "cells_per_element", 0)),
                 attribute(file, "dx", 0), H5Lexists(file, "Ta", H5P_DEFAULT) > 0};
  frame.V = read_frame(V, n);
  if (frame.shape.deforms()) frame.nodes = read_frame(open_dataset(file, "nodes"), n);
  return frame;
}

StoredFrame RunResults::last_frame() const {
  const std::size_t frames = frame_times().size();
  if (frames == 0) throw InputError(fmt::format("{}: no frames", (folder_ / "fields.h5").string()));
  return frame(frames - 1);
}

}  // namespace myowave::apps
