// Reads the files of a run, for pages and figures.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/draw/frame_shape.hpp"

namespace myowave::apps {

// A table of a run folder. A row that its writer did not finish is left out.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::size_t left_out = 0;  // incomplete rows

  bool has(std::string_view column) const;
  // Errors, here and below: std::out_of_range that names the column and those there are.
  std::size_t index_of(std::string_view column) const;
  // Numbers of a column; NaN where a cell is empty.
  std::vector<double> numbers(std::string_view column) const;
};

// Errors: InputError where the file is missing.
CsvTable read_csv(const std::filesystem::path&);

// A frame of fields.h5.
struct StoredFrame {
  double t = 0;  // t.u.
  FrameShape shape;
  std::vector<double> V;      // rows * columns
  std::vector<double> nodes;  // as in solver::Frame; empty in a rigid run
};

class RunResults {
 public:
  // A run that is not finished has no summary.json; where that is accepted the summary is null.
  enum class Unfinished { refuse, accept };
  // Errors: InputError where the folder holds no summary.json, or one that cannot be read.
  explicit RunResults(std::filesystem::path folder, Unfinished = Unfinished::refuse);

  const std::filesystem::path& folder() const { return folder_; }
  const nlohmann::ordered_json& summary() const { return summary_; }
  CsvTable csv(std::string_view name) const { return read_csv(folder_ / name); }

  // Times of the frames in fields.h5, t.u.; empty without that file.
  std::vector<double> frame_times() const;
  // Errors: InputError where there is no such frame.
  StoredFrame frame(std::size_t n) const;
  StoredFrame last_frame() const;

 private:
  std::filesystem::path folder_;
  nlohmann::ordered_json summary_;
};

}  // namespace myowave::apps
