#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "apps/base/hdf5_handle.hpp"
#include "apps/input/initial_state.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

using solver::InputError;

// One dataset of a state: [frame,] row, column.
struct StateDataset {
  std::string name;
  Hdf5Handle id;
  std::vector<hsize_t> size;

  hsize_t frames() const { return size.size() == 3 ? size[0] : 1; }
  int rows() const { return int(size[size.size() - 2]); }
  int columns() const { return int(size[size.size() - 1]); }
};

struct Window {
  int row0, column0, rows, columns;
};

Hdf5Handle open_file(const std::string& file) {
  if (!std::filesystem::exists(file)) throw InputError(fmt::format("{}: no such file", file));
  try {
    return open_hdf5(file);
  } catch (const Hdf5Error& error) {
    throw InputError(
        fmt::format("{} (a state is an HDF5 file with V, r and, where there, Ta)", error.what()));
  }
}

StateDataset open_dataset(hid_t file_id, const std::string& file, const std::string& name) {
  const auto what = fmt::format("{}: dataset {}", file, name);
  StateDataset dataset{name, {H5Dopen2(file_id, name.c_str(), H5P_DEFAULT), H5Dclose, what}, {}};
  const Hdf5Handle type(H5Dget_type(dataset.id), H5Tclose, what);
  const auto kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) throw InputError(what + " does not hold numbers");
  const Hdf5Handle space(H5Dget_space(dataset.id), H5Sclose, what);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != 2 && rank != 3) {
    throw InputError(
        fmt::format("{} has {} dimensions; [row, column] or [frame, row, column] is needed", what, rank));
  }
  dataset.size.resize(std::size_t(rank));
  H5Sget_simple_extent_dims(space, dataset.size.data(), nullptr);
  if (dataset.frames() == 0) throw InputError(what + " holds no frame");
  return dataset;
}

Window place(const std::string& file, const StateDataset& V, int rows, int columns,
             const std::optional<std::array<int, 2>>& window) {
  const auto sizes = fmt::format("{} has {} x {} nodes, the scene's grid {} x {}", file, V.rows(),
                                 V.columns(), rows, columns);
  if (!window) {
    if (V.rows() != rows || V.columns() != columns) {
      throw InputError(sizes +
                       "; set grid.n to the file's, or take a part with initial.window = [row0, column0]");
    }
    return {0, 0, rows, columns};
  }
  const auto [row0, column0] = *window;
  if (rows > V.rows() || columns > V.columns())
    throw InputError(sizes + "; a window is a part of the file's sheet");
  if (row0 < 0 || column0 < 0 || row0 > V.rows() - rows || column0 > V.columns() - columns) {
    throw InputError(fmt::format("{}; initial.window = [{}, {}] leaves it, [0, 0] to [{}, {}] fit", sizes,
                                 row0, column0, V.rows() - rows, V.columns() - columns));
  }
  return {row0, column0, rows, columns};
}

std::vector<double> read_window(const std::string& file, const StateDataset& dataset, hsize_t frame,
                                const Window& w) {
  const auto what = fmt::format("{}: dataset {}", file, dataset.name);
  std::vector<hsize_t> start{hsize_t(w.row0), hsize_t(w.column0)}, count{hsize_t(w.rows), hsize_t(w.columns)};
  if (dataset.size.size() == 3) {
    start.insert(start.begin(), frame);
    count.insert(count.begin(), 1);
  }
  const Hdf5Handle source(H5Dget_space(dataset.id), H5Sclose, what);
  check_hdf5(H5Sselect_hyperslab(source, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), what);
  const Hdf5Handle target(H5Screate_simple(int(count.size()), count.data(), nullptr), H5Sclose, what);
  std::vector<double> values(std::size_t(w.rows) * std::size_t(w.columns));
  check_hdf5(H5Dread(dataset.id, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, values.data()), what);
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!std::isfinite(values[n])) {
      throw InputError(fmt::format("{} is {} at row {}, column {}", what, values[n],
                                   w.row0 + int(n) / w.columns, w.column0 + int(n) % w.columns));
    }
  }
  return values;
}

}  // namespace

solver::InitialState read_state(const std::string& file, int rows, int columns,
                                const std::optional<std::array<int, 2>>& window) {
  const Hdf5Handle file_id = open_file(file);
  try {
    std::vector<StateDataset> datasets;
    for (const char* name : {"V", "r", "Ta"}) {
      // Ta alone may be missing: states of programs without mechanics have none.
      const bool there = H5Lexists(file_id, name, H5P_DEFAULT) > 0;
      if (!there && std::string(name) == "Ta") continue;
      if (!there)
        throw InputError(fmt::format("{}: there is no dataset {} (V, r and, where there, Ta)", file, name));
      datasets.push_back(open_dataset(file_id, file, name));
      const auto &V = datasets.front(), &last = datasets.back();
      if (last.rows() != V.rows() || last.columns() != V.columns()) {
        throw InputError(fmt::format("{}: {} has {} x {} nodes, V {} x {}", file, name, last.rows(),
                                     last.columns(), V.rows(), V.columns()));
      }
    }
    // A file whose writer died may have one more frame of V than of r.
    hsize_t frames = datasets.front().frames();
    for (const auto& dataset : datasets) frames = std::min(frames, dataset.frames());

    const Window w = place(file, datasets.front(), rows, columns, window);
    solver::InitialState state{rows, columns, {}, {}, {}};
    state.V = read_window(file, datasets[0], frames - 1, w);
    state.r = read_window(file, datasets[1], frames - 1, w);
    state.Ta = datasets.size() > 2 ? read_window(file, datasets[2], frames - 1, w)
                                   : std::vector<double>(state.V.size(), 0.0);
    return state;
  } catch (const Hdf5Error& error) {
    throw InputError(error.what());
  }
}

}  // namespace myowave::apps
