// fields.h5: the state at each frame, in datasets whose first index is the frame.
//
//   time   [frame]                 t.u.
//   V, r   [frame, row, column]    dimensionless
//   Ta     [frame, row, column]    kPa, where it is computed
//   nodes  [frame, node, 2]        element nodes x1, x2, length units; node = I (element columns + 1) + J
//   grid   [frame, row, column, 2] grid nodes x1, x2, float32, what a viewer draws V on
//
// A rigid run has neither nodes nor grid. Each frame is a chunk, compressed, and is flushed: a file
// whose writer died, or whose disk is full, holds the frames before. For that the index of a dataset's chunks
// has room for all of them in one node, which is written over in one piece; an index that grows is torn for a
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
  // expected_frames: at most so many are to come; more are an index that grows.
  FieldsFile(std::filesystem::path, const FrameShape&, double ms_per_tu, std::size_t expected_frames);
  // Frames so far, and XXH3 of what they hold, one after another.
  struct Kept {
    std::size_t frames = 0;
    std::uint64_t digest = 0;
  };
  // Goes on with a file that is there, whatever came of what follows the frames that are kept: these are
  // copied into a new one, which takes its place. Errors: std::runtime_error, also where they are not there,
  // or others.
  FieldsFile(const std::filesystem::path&, const FrameShape&, double ms_per_tu, std::size_t expected_frames,
             const Kept&);

  void append(const solver::Frame&);
  std::size_t frames() const { return frames_; }
  Kept kept() const { return {frames_, digest_}; }
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
