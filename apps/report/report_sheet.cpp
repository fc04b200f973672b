#include "apps/report/report_sheet.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/base/page.hpp"
#include "apps/draw/sheet_panel.hpp"
#include "apps/draw/sheet_raster.hpp"

namespace myowave::apps {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t most_frames = 300;   // 12 s of movie
constexpr int fewest_samples = 101;        // along the longer side, before frames are left out
constexpr std::size_t most_tips = 40'000;  // 1 MB

// Number of samples out of n, at every `stride` and the last.
int samples(int n, int stride) { return (n - 1 + stride - 1) / stride + 1; }

struct Sampling {
  int rows, columns;
  std::size_t frames;
};

Sampling choose(const FrameShape& shape, std::size_t frames, std::size_t bytes) {
  Sampling chosen{shape.rows, shape.columns, std::min(frames, most_frames)};
  const std::size_t nodes = 8 * shape.element_nodes();
  const auto size = [&] { return std::size_t(chosen.rows) * std::size_t(chosen.columns) + nodes; };
  for (int stride = 2;
       chosen.frames * size() > bytes && std::max(shape.rows, shape.columns) / stride >= fewest_samples - 1;
       ++stride)
    chosen.rows = samples(shape.rows, stride), chosen.columns = samples(shape.columns, stride);
  chosen.frames = std::clamp<std::size_t>(bytes / size(), 1, chosen.frames);
  return chosen;
}

// Bilinear between the grid nodes.
void append_V(std::string& bytes, const StoredFrame& frame, const Sampling& sampling) {
  const FrameShape& shape = frame.shape;
  for (int i = 0; i < sampling.rows; ++i) {
    const double row = double(i) * (shape.rows - 1) / (sampling.rows - 1);
    for (int j = 0; j < sampling.columns; ++j) {
      const double column = double(j) * (shape.columns - 1) / (sampling.columns - 1);
      const double V = sheet_V({shape, frame.V, {}}, row, column);
      bytes += static_cast<char>(std::lround(255 * std::clamp(V, 0.0, 1.0)));
    }
  }
}

void append_nodes(std::string& bytes, std::span<const double> nodes) {
  for (const double value : nodes) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (const unsigned shift : {0U, 8U, 16U, 24U}) bytes += static_cast<char>(bits >> shift & 255U);
  }
}

double rounded(double value) { return std::round(1e4 * value) / 1e4; }

json tips_json(const CsvTable& tips) {
  if (tips.rows.empty()) return nullptr;
  json result = json::object();
  const std::size_t every = 1 + tips.rows.size() / most_tips;
  for (const char* column : {"t", "x", "y", "charge", "trajectory"}) {
    if (!tips.has(column)) continue;
    const auto values = tips.numbers(column);
    json& list = result[column] = json::array();
    for (std::size_t n = 0; n < values.size(); n += every) list.push_back(rounded(values[n]));
  }
  return result;
}

}  // namespace

PackedSheet pack_sheet(const ReportRun& run, std::size_t bytes) {
  const std::vector<double> all = run.results().frame_times();
  PackedSheet packed;
  packed.stored_frames = all.size();
  if (all.empty()) return packed;
  const FrameShape shape = run.results().frame(0).shape;
  const Sampling sampling = choose(shape, all.size(), bytes);
  std::string V, nodes;
  json times = json::array();
  std::optional<SheetExtent> extent;
  for (std::size_t n = 0; n < sampling.frames; ++n) {
    const std::size_t at =
        sampling.frames > 1 ? n * (all.size() - 1) / (sampling.frames - 1) : all.size() - 1;
    const StoredFrame frame = run.results().frame(at);
    times.push_back(rounded(frame.t));
    append_V(V, frame, sampling);
    if (shape.deforms()) append_nodes(nodes, frame.nodes);
    const SheetExtent one = sheet_extent({.shape = shape, .nodes = frame.nodes});
    extent = extent ? joined(*extent, one) : one;
  }
  if (!shape.deforms()) append_nodes(nodes, sheet_corners(shape));
  packed.json = json{{"rows", sampling.rows},
                     {"columns", sampling.columns},
                     {"element_rows", std::max(1, shape.element_rows())},
                     {"element_columns", std::max(1, shape.element_columns())},
                     {"length", {(shape.columns - 1) * shape.dx, (shape.rows - 1) * shape.dx}},
                     {"extent", {extent->low_1, extent->low_2, extent->high_1, extent->high_2}},
                     {"ms_per_tu", run.ms_per_tu()},
                     {"times", std::move(times)},
                     {"tips", tips_json(run.tips())}}
                    .dump();
  packed.V = base64(V);
  packed.nodes = base64(nodes);
  packed.frames = sampling.frames;
  return packed;
}

}  // namespace myowave::apps
