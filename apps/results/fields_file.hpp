// fields.h5: the state at each frame, in datasets whose first index is the frame.
//
//   time   [frame]                 t.u.
//   V, r   [frame, row, column]    dimensionless
//   Ta     [frame, row, column]    kPa, where it is computed
//   nodes  [frame, node, 2]        element nodes x1, x2, length units; node = I (element columns + 1) + J
//   grid   [frame, row, column, 2] grid nodes x1, x2, float32, what a viewer draws V on
//
// A rigid run has neither nodes nor grid. Each frame is one compressed chunk and is flushed. If the writer
// dies or the disk is full, the file still holds the earlier frames. For this, one node of the chunk index
// has room for all chunks and is overwritten in one piece; a growing index would be inconsistent for a
// moment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/base/hdf5_handle.hpp"
#include "apps/draw/frame_shape.hpp"
#include "solver/base/run_output.hpp"

namespace myowave::apps {

class FieldsFile {
 public:
  // Errors: std::runtime_error "cannot write FILE: reason", here and in append.
  // expected_frames: upper bound of the number of frames. With more frames the index grows.
  FieldsFile(std::filesystem::path, const FrameShape&, double ms_per_tu, std::size_t expected_frames);
  // Frames so far, and XXH3 of their contents in order.
  struct Saved {
    std::size_t frames = 0;
    std::uint64_t digest = 0;
  };
  // Resumes an existing file after its saved frames, which are copied into a new file that replaces it.
  // Later frames, even damaged ones, are dropped. Errors: std::runtime_error, also if saved frames are
  // missing or differ.
  FieldsFile(const std::filesystem::path&, const FrameShape&, double ms_per_tu, std::size_t expected_frames,
             const Saved&);

  void append(const solver::Frame&);
  std::size_t frames() const { return frames_; }
  Saved saved() const { return {frames_, digest_}; }
  // All frames are on the disk when this returns.
  void sync();

 private:
  struct Dataset {
    Hdf5Handle id;
    std::vector<hsize_t> frame;  // shape of one frame
  };
  Dataset create(const char* name, std::vector<hsize_t> frame, hid_t file_type, const char* unit,
                 const char* description);
  void copy_frames(const std::filesystem::path& from, std::size_t frames);
  void extend(const Dataset&, hid_t memory_type, const void* values);
  void append_datasets(const solver::Frame&);

  std::filesystem::path path_;
  FrameShape shape_;
  Hdf5Handle file_;
  Dataset time_, V_, r_, Ta_, nodes_, grid_;
  std::size_t frames_ = 0;
  std::uint64_t digest_ = 0;
};

}  // namespace myowave::apps
