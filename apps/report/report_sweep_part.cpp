// A sweep's part of report.html.
#include <fmt/format.h>

#include <algorithm>

#include "apps/base/page.hpp"
#include "apps/base/time_units.hpp"
#include "apps/report/report_html.hpp"
#include "apps/report/report_parts.hpp"
#include "apps/report/report_sweep.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;

// Of the pairs of a sweep: how often the other run broke up later than the reference, and by how much.
std::string pairs_html(const SweepTable& sweep) {
  const auto pairs = pair_rows(sweep);
  if (pairs.empty()) return "";
  const auto names = pair_names(sweep);
  std::vector<std::vector<std::string>> rows;
  for (const auto& [what, count] : pairs) {
    std::vector<double> delays = count.delays;
    std::ranges::sort(delays);
    const std::string spread =
        delays.empty() ? "–"
                       : fmt::format("{:.3g} ({:.3g} to {:.3g})", to_seconds(delays[delays.size() / 2]),
                                     to_seconds(delays.front()), to_seconds(delays.back()));
    rows.push_back({html_escape(what), std::to_string(count.later), std::to_string(count.never),
                    std::to_string(count.earlier), std::to_string(count.undecided), spread,
                    std::to_string(count.missing)});
  }
  return fmt::format(
             "<h3>Pairs from the same state</h3>\n<p>First break-up of the {0} run against the {1} run. "
             "Never: the {1} run broke up, the {0} run did not up to its end. Undecided: neither broke up "
             "while both ran.</p>\n",
             html_escape(names[1]), html_escape(names[0])) +
         html_table(
             {"", "later", "never", "earlier", "undecided", "delay in s: median (least to most)", "not done"},
             rows);
}

std::string costs_html(const SweepTable& sweep) {
  double wall = 0, precondition = 0, cell_steps = 0;
  for (const auto& row : sweep.cells) {
    const auto number = [&](const char* name) {
      const auto& cell = row[sweep.column(name)];
      return cell.is_number() ? cell.get<double>() : 0.0;
    };
    wall += number("wall_s");
    precondition += number("wall_precondition_s");
    cell_steps += number("cell_steps_per_s") * number("wall_s");
  }
  const std::size_t done = sweep.cells.size();
  std::vector<std::vector<std::string>> rows{
      {"runs done", fmt::format("{} of {}", done, sweep.plan.runs.size())},
      {"failed", std::to_string(sweep.failed)},
      {"time of the runs, each on its thread", fmt::format("{:.4g} s", wall)},
      {"of their own preconditions", fmt::format("{:.4g} s", precondition)}};
  if (wall > 0)
    rows.push_back({"throughput of a thread",
                    fmt::format("{:.3g} million cell steps a second", 1e-6 * cell_steps / wall)});
  return "<h3>Runs and costs</h3>\n" + html_table({}, rows);
}

// The columns that some run has.
std::string records_html(const SweepTable& sweep) {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows(sweep.cells.size());
  for (std::size_t n = 0; n < sweep.columns.size(); ++n) {
    if (std::ranges::all_of(sweep.cells, [&](const auto& row) { return row[n].is_null(); })) continue;
    head.push_back(html_escape(sweep.columns[n]));
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const auto& cell = sweep.cells[row][n];
      rows[row].push_back(cell.is_number_float() ? fmt::format("{:.6g}", cell.get<double>()) : plain(cell));
    }
  }
  return rows.empty() ? "" : "<h3>Table</h3>\n" + html_table(head, rows);
}

}  // namespace

std::string sweep_html(const fs::path& folder, const fs::path& plots, const std::string& prefix) {
  const SweepTable sweep = read_table(folder);
  std::string html = fmt::format("<h2>{}</h2>\n", html_escape(sweep.plan.name));
  if (sweep.missing > 0)
    html += fmt::format("<p class=\"note\">{} of {} runs are not done.</p>\n", sweep.missing,
                        sweep.plan.runs.size());
  for (const auto& line : sweep.refused)
    html += fmt::format("<p class=\"warning\">{}</p>\n", html_escape(line));
  return html + plots_html(sweep_plots(sweep), plots, prefix) + pairs_html(sweep) + costs_html(sweep) +
         records_html(sweep);
}

}  // namespace myowave::apps
