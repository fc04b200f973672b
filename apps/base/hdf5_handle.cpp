#include "apps/base/hdf5_handle.hpp"

#include <string_view>

namespace myowave::apps {
namespace {

herr_t keep_innermost(unsigned depth, const H5E_error2_t* entry, void* text) {
  if (depth == 0 && entry->desc != nullptr) *static_cast<std::string*>(text) = entry->desc;
  return 0;
}

std::string reason() {
  std::string text = "unknown reason";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &text);
  // The file driver wraps the system's words into a list of numbers.
  constexpr std::string_view mark = "error message = '";
  if (const auto begin = text.find(mark); begin != std::string::npos) {
    const auto end = text.find('\'', begin + mark.size());
    text = text.substr(begin + mark.size(), end - begin - mark.size());
  }
  return text;
}

}  // namespace

Hdf5Handle::Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
  if (id < 0) throw Hdf5Error(what + ": " + reason());
}

void check_hdf5(herr_t status, const std::string& what) {
  if (status < 0) throw Hdf5Error(what + ": " + reason());
}

void start_hdf5() {
  [[maybe_unused]] static const herr_t once = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Handle open_hdf5(const std::filesystem::path& file) {
  start_hdf5();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, file.string());
  // Reading needs no lock, and a run that still writes the file may hold one.
  check_hdf5(H5Pset_file_locking(access, false, true), file.string());
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), H5Fclose, file.string()};
}

StoredDataset open_dataset(hid_t file, const char* name) {
  StoredDataset dataset{{H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, name}, {}};
  const Hdf5Handle space(H5Dget_space(dataset.id), H5Sclose, name);
  dataset.size.resize(std::size_t(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, dataset.size.data(), nullptr);
  return dataset;
}

std::vector<double> read_frame(const StoredDataset& dataset, std::size_t n) {
  std::vector<hsize_t> start(dataset.size.size(), 0), count = dataset.size;
  start[0] = n;
  count[0] = 1;
  std::size_t values = 1;
  for (const hsize_t extent : count) values *= extent;
  const Hdf5Handle source(H5Dget_space(dataset.id), H5Sclose, "frame");
  check_hdf5(H5Sselect_hyperslab(source, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
             "frame");
  const Hdf5Handle target(H5Screate_simple(int(count.size()), count.data(), nullptr), H5Sclose, "frame");
  std::vector<double> frame(values);
  check_hdf5(H5Dread(dataset.id, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, frame.data()), "frame");
  return frame;
}

void write_attribute(hid_t object, const char* name, const std::string& text) {
  const std::string what = std::string("attribute ") + name;
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose, what);
  check_hdf5(H5Tset_size(type, H5T_VARIABLE), what);
  check_hdf5(H5Tset_cset(type, H5T_CSET_UTF8), what);
  const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, what);
  const Hdf5Handle attribute(H5Acreate2(object, name, type, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                             what);
  const char* characters = text.c_str();
  check_hdf5(H5Awrite(attribute, type, static_cast<const void*>(&characters)), what);
}

void write_attribute(hid_t object, const char* name, double value) {
  const std::string what = std::string("attribute ") + name;
  const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, what);
  const Hdf5Handle attribute(H5Acreate2(object, name, H5T_IEEE_F64LE, scalar, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose, what);
  check_hdf5(H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value), what);
}

}  // namespace myowave::apps
