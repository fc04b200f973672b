// `myowave report`: one page that shows runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace myowave::apps {

struct ReportRequest {
  std::vector<std::string> folders;  // of runs, of sweeps, or of a reproduction
  std::string out;                   // empty: report.html in the first folder
  bool movie = false;                // movie.mp4 beside it, of each run (`N_movie.mp4` of several)
};

// Writes the page, and into `plots/` beside it each plot as PNG and SVG.
// Errors: InputError for a folder that is none of these; std::runtime_error where a
// file cannot be read or written.
void report(const ReportRequest&);

}  // namespace myowave::apps
