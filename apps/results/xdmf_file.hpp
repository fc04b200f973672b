// fields.xdmf: shows a viewer (ParaView's "XDMF Reader", VisIt) how to show fields.h5: V, r and, where it
// is computed, Ta as a time series on the deformed grid, or on the regular one of a rigid run. (ParaView's
// Xdmf3 readers know no part of a dataset, which is what a frame is.)
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "apps/base/file_io.hpp"
#include "apps/draw/frame_shape.hpp"

namespace myowave::apps {

class XdmfFile {
 public:
  // Errors: std::runtime_error "cannot write FILE: reason", here and in append.
  XdmfFile(const std::filesystem::path&, const FrameShape&, std::string fields_name);

  // Resumes an existing file, see AppendedFile.
  XdmfFile(const std::filesystem::path&, const FrameShape&, std::string fields_name, std::uintmax_t size);

  std::uintmax_t sync() { return file_.sync(); }

  // The file is complete after each frame.
  void append(std::size_t frame, double t);

 private:
  XdmfFile(const FrameShape&, std::string fields_name, AppendedFile);
  std::string slab(std::string_view dataset, int precision, bool vector, std::size_t frame) const;

  FrameShape shape_;
  std::string fields_name_;
  std::string grid_size_;
  AppendedFile file_;
};

}  // namespace myowave::apps
