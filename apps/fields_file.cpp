#include "apps/fields_file.hpp"

#include <utility>

#include "myowave_version.hpp"

namespace myowave::apps {
namespace {

// Beyond level 1 the noise in the mantissas costs time and saves nothing.
constexpr unsigned deflate_level = 1;
constexpr hsize_t times_per_chunk = 128;

Hdf5Handle create_file(const std::string& path, const std::string& what) {
  start_hdf5();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  // Without the writer's lock the file opens in other programs while the run goes on; each frame is
  // flushed, so they find it whole.
  check_hdf5(H5Pset_file_locking(access, false, true), what);
  // Chunks go to the disk when they are written, before the flush writes the index that names them.
  check_hdf5(H5Pset_cache(access, 0, 0, 0, 0), what);
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, what};
}

std::string failing(const std::filesystem::path& path) { return "cannot write " + path.string(); }

}  // namespace

FieldsFile::FieldsFile(std::filesystem::path path, const FrameShape& shape, double ms_per_tu)
    : path_(std::move(path)), shape_(shape), file_(create_file(path_.string(), failing(path_))) {
  const auto rows = hsize_t(shape.rows), columns = hsize_t(shape.columns);
  write_attribute(file_, "program", std::string("myowave ") + version);
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
    // Closing would write an index that names data which are not there.
    for (auto* dataset : {&time_, &V_, &r_, &Ta_, &nodes_, &grid_}) dataset->id.abandon();
    file_.abandon();
    throw;
  }
  ++frames_;
}

void FieldsFile::append_datasets(const solver::Frame& frame) {
  extend(V_, H5T_NATIVE_DOUBLE, frame.V.data());
  extend(r_, H5T_NATIVE_DOUBLE, frame.r.data());
  if (shape_.tension) extend(Ta_, H5T_NATIVE_DOUBLE, frame.Ta.data());
  if (shape_.deforms()) {
    extend(nodes_, H5T_NATIVE_DOUBLE, frame.nodes.data());
    extend(grid_, H5T_NATIVE_FLOAT, grid_positions(shape_, frame.nodes).data());
  }
  // Last, so that a time is only there with its fields.
  extend(time_, H5T_NATIVE_DOUBLE, &frame.t);
  check_hdf5(H5Fflush(file_, H5F_SCOPE_GLOBAL), failing(path_));
}

}  // namespace myowave::apps
