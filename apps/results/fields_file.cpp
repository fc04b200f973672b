#include "apps/results/fields_file.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <system_error>
#include <utility>

#include "apps/base/file_io.hpp"
#include "apps/base/revision.hpp"

namespace myowave::apps {
namespace {

// Beyond level 1 the noise in the mantissas costs time and saves nothing.
constexpr unsigned deflate_level = 1;
constexpr hsize_t times_per_chunk = 128;

// Half of the entries of a node of a chunk index, which HDF5 takes as 16 bits.
unsigned index_width(std::size_t frames) {
  return static_cast<unsigned>(std::clamp<std::size_t>((frames + 1) / 2 + 1, 32, 32767));
}

Hdf5Handle create_file(const std::string& path, const std::string& what, std::size_t expected_frames) {
  start_hdf5();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  // No lock, so that other programs can open the file during the run. Each frame is flushed: they read
  // complete frames.
  check_hdf5(H5Pset_file_locking(access, false, true), what);
  // Chunks go to the disk when they are written, before the flush writes the index that names them.
  check_hdf5(H5Pset_cache(access, 0, 0, 0, 0), what);
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, what);
  check_hdf5(H5Pset_istore_k(creation, index_width(expected_frames)), what);
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, what};
}

std::string failing(const std::filesystem::path& path) { return "cannot write " + path.string(); }

}  // namespace

FieldsFile::FieldsFile(std::filesystem::path path, const FrameShape& shape, double ms_per_tu,
                       std::size_t expected_frames)
    : path_(std::move(path)),
      shape_(shape),
      file_(create_file(path_.string(), failing(path_), expected_frames)) {
  const auto rows = hsize_t(shape.rows), columns = hsize_t(shape.columns);
  write_attribute(file_, "program", std::string("myowave ") + version());
  write_attribute(file_, "dx", shape.dx);
  write_attribute(file_, "ms_per_tu", ms_per_tu);
  time_ = create("time", {}, H5T_IEEE_F64LE, "t.u.", "time");
  V_ = create("V", {rows, columns}, H5T_IEEE_F64LE, "1", "transmembrane potential; E[mV] = -80 + 100 V");
  r_ = create("r", {rows, columns}, H5T_IEEE_F64LE, "1", "recovery variable");
  if (shape.tension) Ta_ = create("Ta", {rows, columns}, H5T_IEEE_F64LE, "kPa", "active tension");
  if (shape.deforms()) {
    write_attribute(file_, "cells_per_element", double(shape.cells));
    nodes_ = create("nodes", {hsize_t(shape.element_nodes()), 2}, H5T_IEEE_F64LE, "length units",
                    "element nodes (x1, x2); node = I (element columns + 1) + J");
    grid_ = create("grid", {rows, columns, 2}, H5T_IEEE_F32LE, "length units",
                   "grid nodes (x1, x2), bilinear in each element");
  }
  check_hdf5(H5Fflush(file_, H5F_SCOPE_GLOBAL), failing(path_));
}

FieldsFile::FieldsFile(const std::filesystem::path& path, const FrameShape& shape, double ms_per_tu,
                       std::size_t expected_frames, const Saved& saved)
    : FieldsFile(path.string() + ".tmp", shape, ms_per_tu, expected_frames) {
  copy_frames(path, saved.frames);
  if (digest_ != saved.digest)
    throw std::runtime_error(
        fmt::format("cannot resume {}: its frames are not those that were written", path.string()));
  sync();
  std::filesystem::rename(path_, path);
  path_ = path;
}

void FieldsFile::copy_frames(const std::filesystem::path& from, std::size_t frames) {
  const std::string what = fmt::format("cannot resume {}", from.string());
  // The writer may have died between noting a new size and changing it.
  constexpr std::uintmax_t room = 1 << 20;
  std::error_code error;
  std::filesystem::resize_file(from, std::filesystem::file_size(from, error) + room, error);
  if (error) throw std::runtime_error(fmt::format("{}: {}", what, error.message()));
  const Hdf5Handle file = open_hdf5(from);
  const auto read = [&](const char* name, std::size_t n) {
    const StoredDataset dataset = open_dataset(file, name);
    if (dataset.size[0] <= n)
      throw std::runtime_error(
          fmt::format("{}: {} of the {} frames that it had are there", what, dataset.size[0], frames));
    return read_frame(dataset, n);
  };
  for (std::size_t n = 0; n < frames; ++n) {
    const auto V = read("V", n), r = read("r", n);
    const auto Ta = shape_.tension ? read("Ta", n) : std::vector<double>();
    const auto nodes = shape_.deforms() ? read("nodes", n) : std::vector<double>();
    append({read("time", n)[0], shape_.rows, shape_.columns, shape_.element_rows(), shape_.element_columns(),
            V, r, Ta, nodes});
  }
}

void FieldsFile::sync() { sync_file(path_); }

FieldsFile::Dataset FieldsFile::create(const char* name, std::vector<hsize_t> frame, hid_t file_type,
                                       const char* unit, const char* description) {
  const std::string what = failing(path_);
  std::vector<hsize_t> size{0}, largest{H5S_UNLIMITED}, chunk{frame.empty() ? times_per_chunk : 1};
  for (auto* shape : {&size, &largest, &chunk}) shape->insert(shape->end(), frame.begin(), frame.end());

  const Hdf5Handle space(H5Screate_simple(int(size.size()), size.data(), largest.data()), H5Sclose, what);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  check_hdf5(H5Pset_chunk(creation, int(chunk.size()), chunk.data()), what);
  if (!frame.empty()) {
    check_hdf5(H5Pset_shuffle(creation), what);
    check_hdf5(H5Pset_deflate(creation, deflate_level), what);
  }
  Dataset dataset{
      {H5Dcreate2(file_, name, file_type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose, what},
      std::move(frame)};
  write_attribute(dataset.id, "units", unit);
  write_attribute(dataset.id, "long_name", description);
  return dataset;
}

void FieldsFile::extend(const Dataset& dataset, hid_t memory_type, const void* values) {
  const std::string what = failing(path_);
  std::vector<hsize_t> size{frames_ + 1}, start{frames_}, count{1};
  size.insert(size.end(), dataset.frame.begin(), dataset.frame.end());
  start.insert(start.end(), dataset.frame.size(), 0);
  count.insert(count.end(), dataset.frame.begin(), dataset.frame.end());

  check_hdf5(H5Dset_extent(dataset.id, size.data()), what);
  const Hdf5Handle target(H5Dget_space(dataset.id), H5Sclose, what);
  check_hdf5(H5Sselect_hyperslab(target, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), what);
  const Hdf5Handle source(H5Screate_simple(int(count.size()), count.data(), nullptr), H5Sclose, what);
  check_hdf5(H5Dwrite(dataset.id, memory_type, source, target, H5P_DEFAULT, values), what);
}

void FieldsFile::append(const solver::Frame& frame) {
  try {
    append_datasets(frame);
  } catch (const Hdf5Error&) {
    // Closing would write an index that refers to missing data.
    for (auto* dataset : {&time_, &V_, &r_, &Ta_, &nodes_, &grid_}) dataset->id.abandon();
    file_.abandon();
    throw;
  }
  ++frames_;
  const std::span<const double> none;
  for (const auto values : {std::span(&frame.t, 1), frame.V, frame.r, shape_.tension ? frame.Ta : none,
                            shape_.deforms() ? frame.nodes : none})
    digest_ = XXH3_64bits_withSeed(values.data(), values.size_bytes(), digest_);
}

void FieldsFile::append_datasets(const solver::Frame& frame) {
  extend(V_, H5T_NATIVE_DOUBLE, frame.V.data());
  extend(r_, H5T_NATIVE_DOUBLE, frame.r.data());
  if (shape_.tension) extend(Ta_, H5T_NATIVE_DOUBLE, frame.Ta.data());
  if (shape_.deforms()) {
    extend(nodes_, H5T_NATIVE_DOUBLE, frame.nodes.data());
    extend(grid_, H5T_NATIVE_FLOAT, grid_positions(shape_, frame.nodes).data());
  }
  // Last, so that no time stands without its fields.
  extend(time_, H5T_NATIVE_DOUBLE, &frame.t);
  check_hdf5(H5Fflush(file_, H5F_SCOPE_GLOBAL), failing(path_));
}

}  // namespace myowave::apps
