#include "apps/report/report.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>

#include "apps/base/embedded_files.hpp"
#include "apps/base/file_io.hpp"
#include "apps/base/page.hpp"
#include "apps/report/movie.hpp"
#include "apps/report/report_html.hpp"
#include "apps/report/report_parts.hpp"
#include "apps/report/report_sweep.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;

// Of all sheets together, before base64, which makes a page of 15 MB at most.
constexpr std::size_t bytes_of_sheets = 10'000'000;

// The colours of V as the canvas takes them: 256 times red, green, blue.
std::string colour_table() {
  std::string bytes;
  for (int level = 0; level < 256; ++level) {
    const Colour colour = colour_of(level / 255.0);
    for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) bytes += static_cast<char>(part);
  }
  return base64(bytes);
}

std::string scripts_html() {
  std::string html = fmt::format("<style>\n{}</style>\n", embedded_file("report.css"));
  if (const auto uplot = embedded_file("uPlot.iife.min.js"); !uplot.empty()) {
    html += fmt::format("<!-- uPlot, its licence:\n{}-->\n<style>{}</style>\n<script>{}</script>\n",
                        embedded_file("LICENSE"), embedded_file("uPlot.min.css"), uplot);
  }
  return html + fmt::format("<script type=\"text/plain\" id=\"colours\">{}</script>\n<script>\n{}</script>\n",
                            colour_table(), embedded_file("report.js"));
}

}  // namespace

void report(const ReportRequest& request) {
  std::vector<ReportRun> runs;
  std::vector<fs::path> reproductions, sweeps;
  for (const fs::path folder : request.folders) {
    if (fs::exists(folder / "reproduction.json"))
      reproductions.push_back(folder);
    else if (SweepFolder(folder).is_sweep())
      sweeps.push_back(folder);
    else
      runs.emplace_back(folder);
  }
  const fs::path out =
      request.out.empty() ? fs::path(request.folders.at(0)) / "report.html" : fs::path(request.out);
  if (out.has_parent_path()) fs::create_directories(out.parent_path());
  const fs::path plots = out.parent_path() / "plots";

  const bool alone = runs.size() == 1 && reproductions.empty() && sweeps.empty();
  const std::string title = alone ? runs[0].name() : fmt::format("{} runs", runs.size());
  std::string body = fmt::format("<h1>{}</h1>\n", html_escape(!runs.empty()    ? title
                                                              : sweeps.empty() ? "A paper reproduced"
                                                                               : "Sweeps"));
  if (runs.size() > 1) body += comparison_html(runs) + plots_html(sweep_plots(runs), plots, "");
  for (std::size_t n = 0; n < runs.size(); ++n) {
    const std::string prefix = alone ? "" : fmt::format("{}_", n);
    if (!alone) body += fmt::format("<h2 id=\"run-{}\">{}</h2>\n", n, html_escape(runs[n].name()));
    body += run_html(runs[n], plots, prefix, bytes_of_sheets / runs.size());
    if (!request.movie) continue;
    const std::string reason = write_movie(runs[n], out.parent_path() / (prefix + "movie.mp4"));
    if (!reason.empty()) fmt::print(stderr, "myowave: {}: {}\n", runs[n].name(), reason);
  }
  for (std::size_t n = 0; n < sweeps.size(); ++n)
    body += sweep_html(sweeps[n], plots, sweeps.size() > 1 ? fmt::format("sweep_{}_", n) : "");
  for (const fs::path& folder : reproductions)
    body += "<h2>Figures and their rows</h2>\n" + reproduction_html(folder);
  replace_file(out, html_page(title, body, scripts_html()));
  fmt::print("{}\n", out.string());
}

}  // namespace myowave::apps
