// The frames of a run as a movie.
#pragma once

#include <filesystem>
#include <string>

#include "apps/report/report_run.hpp"

namespace myowave::apps {

// Writes an MP4 (H.264, 24 frames per second) with ffmpeg. Returns an empty text, or the reason if ffmpeg is
// missing or fails, or if the run has no fields.h5.
std::string write_movie(const ReportRun&, const std::filesystem::path& file);

}  // namespace myowave::apps
