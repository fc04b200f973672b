// The frames of a run as report.html carries them.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/report/report_run.hpp"

namespace myowave::apps {

struct PackedSheet {
  // What the page draws with: rows, columns (of the samples), element_rows, element_columns, length
  // (undeformed, along X1 and X2), extent (of all frames: low X1, low X2, high X1, high X2), times (t.u.) and
  // tips.
  std::string json;
  std::string V;      // bytes (frame, row, column), 255: V >= 1, base64
  std::string nodes;  // float32, little-endian (frame, node, {x1, x2}), base64; a rigid sheet has one frame
                      // of corners
  std::size_t frames = 0, stored_frames = 0;
};

// Frames and nodes are left out evenly so that all stay below `bytes`. No frame where there is no fields.h5.
// Errors: InputError, std::runtime_error where fields.h5 cannot be read.
PackedSheet pack_sheet(const ReportRun&, std::size_t bytes);

}  // namespace myowave::apps
