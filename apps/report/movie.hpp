// The frames of a run as a film.
#pragma once

#include <filesystem>
#include <string>

#include "apps/report/report_run.hpp"

namespace myowave::apps {

// Writes an MP4 (H.264, 24 pictures a second) by ffmpeg. Returns why not, where there is no ffmpeg, it fails,
// or the run has no fields.h5; else an empty text.
std::string write_movie(const ReportRun&, const std::filesystem::path& file);

}  // namespace myowave::apps
