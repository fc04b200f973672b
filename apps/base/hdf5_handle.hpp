// HDF5 identifiers that close themselves, and HDF5's errors as exceptions.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace myowave::apps {

// The reason is the innermost entry of HDF5's error stack: "No space left on device".
struct Hdf5Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  // Errors: Hdf5Error if `id` is negative, which is how HDF5 returns a failure.
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what);
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }

  operator hid_t() const { return id_; }
  // Never closes the object.
  void abandon() { id_ = H5I_INVALID_HID; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  herr_t (*close_)(hid_t) = nullptr;
};

// Errors: Hdf5Error "WHAT: reason" where `status` is negative.
void check_hdf5(herr_t status, const std::string& what);

// To be called before any other call of HDF5: errors come as exceptions only, not on stderr as well,
// and HDF5 does nothing at exit (its clean-up crashes where a file could not be flushed, on a full
// disk; the handles have closed all others by then).
void start_hdf5();

// Opens a file for reading, also while a run writes it.
Hdf5Handle open_hdf5(const std::filesystem::path&);

struct StoredDataset {
  Hdf5Handle id;
  std::vector<hsize_t> size;
};
StoredDataset open_dataset(hid_t file, const char* name);

// Frame n of a dataset (frame, ...): the numbers of that frame.
std::vector<double> read_frame(const StoredDataset&, std::size_t n);

void write_attribute(hid_t object, const char* name, const std::string& text);
void write_attribute(hid_t object, const char* name, double value);

}  // namespace myowave::apps
