// Several runs side by side in report.html.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "apps/base/page.hpp"
#include "apps/report/difference_text.hpp"
#include "apps/report/report_html.hpp"
#include "apps/report/report_parts.hpp"
#include "apps/results/observables.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;

// Whether two runs differ in their periods and in their numbers of sources: the unpaired t-test, and one that
// knows how many independent samples there are.
std::string tests_html(const ReportRun& first, const ReportRun& second) {
  const auto has = [&](const char* file) {
    return fs::exists(first.results().folder() / file) && fs::exists(second.results().folder() / file);
  };
  std::vector<std::vector<std::string>> rows;
  const auto add = [&rows](const char* what, const std::vector<double>& a, const std::vector<double>& b) {
    const DifferenceText text = difference_text(a, b);
    rows.push_back({what, html_escape(text.difference), html_escape(text.samples)});
  };
  if (has("beats.csv")) {
    const auto periods = [](const ReportRun& run) {
      const nlohmann::json configuration = run.configuration();
      const double from = configuration.is_object()
                              ? configuration.value(nlohmann::json::json_pointer("/output/period_from"), 0.0)
                              : 0.0;
      return all_periods(periods_of(run.results(), from));
    };
    add("period (t.u.)", periods(first), periods(second));
  }
  if (has("sources.csv")) {
    const auto sources = [](const ReportRun& run) {
      return run.results().csv("sources.csv").numbers("sources");
    };
    add("tips", sources(first), sources(second));
  }
  return rows.empty() ? "" : html_table({"first less second run", "difference of means", "samples"}, rows);
}

}  // namespace

std::string comparison_html(const std::vector<ReportRun>& runs) {
  std::vector<std::string> head{""};
  std::vector<std::string> order;
  std::vector<std::map<std::string, std::string>> columns(runs.size());
  const auto enter = [&](std::size_t n, const std::string& what, const std::string& value) {
    if (std::ranges::find(order, what) == order.end()) order.push_back(what);
    columns[n][what] = value;
  };
  std::set<std::string> parameters;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    head.push_back(fmt::format("<a href=\"#run-{}\">{}</a>", n, html_escape(runs[n].name())));
    for (const auto& one : runs[n].changed_parameters()) {
      const std::string what = fmt::format("<code>{}</code>", html_escape(one.key));
      parameters.insert(what);
      enter(n, what, plain(one.value));
      for (std::size_t other = 0; other < runs.size(); ++other)
        if (!columns[other].contains(what)) columns[other][what] = plain(one.by_default);
    }
  }
  for (std::size_t n = 0; n < runs.size(); ++n)
    for (const Fact& fact : runs[n].numbers()) enter(n, html_escape(fact.what), html_escape(fact.value));
  std::vector<std::vector<std::string>> rows;
  for (const std::string& what : order) {
    std::vector<std::string> row{what};
    for (auto& column : columns) row.push_back(column.contains(what) ? column[what] : "–");
    const bool same = std::equal(row.begin() + 2, row.end(), row.begin() + 1);
    if (parameters.contains(what) && same) continue;
    rows.push_back(row);
  }
  return "<h2>Side by side</h2>\n" + html_table(head, rows) +
         (runs.size() == 2 ? tests_html(runs[0], runs[1]) : "");
}

}  // namespace myowave::apps
