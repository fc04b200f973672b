#include "apps/paper/reproduce.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/base/file_io.hpp"
#include "apps/base/page.hpp"
#include "apps/base/revision.hpp"
#include "apps/draw/figure.hpp"
#include "apps/input/did_you_mean.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// A figure with what became of it: made, or why not.
struct Outcome {
  FigureRecipe recipe;
  MadeFigure made;
  std::string failure;
};

// The jobs of all recipes, each name once.
std::vector<Job> jobs_of(std::span<const FigureRecipe> recipes, Extent extent) {
  std::vector<Job> all;
  for (const auto& recipe : recipes)
    for (auto& job : recipe.jobs(extent))
      if (std::ranges::find(all, job.name, &Job::name) == all.end()) all.push_back(std::move(job));
  return all;
}

std::map<std::string, JobOutcome> run_all(std::span<const Job> jobs, const fs::path& folder, int parallel) {
  const bool terminal = isatty(STDERR_FILENO) == 1;
  const auto report = [&](const std::string& name, const JobOutcome& outcome, std::size_t done) {
    const std::string what = !outcome.ok()    ? fmt::format("failed: {}", outcome.message)
                             : outcome.reused ? "done before"
                                              : fmt::format("{:.1f} s", outcome.seconds);
    fmt::print(stderr, "{}{} of {} runs: {}: {}{}", terminal ? "\r\x1b[K" : "", done, jobs.size(), name, what,
               terminal && outcome.ok() ? "" : "\n");
  };
  auto outcomes = run_jobs(fs::read_symlink("/proc/self/exe"), jobs, folder, parallel, report);
  if (terminal && !jobs.empty()) fmt::print(stderr, "\n");
  return outcomes;
}

Outcome make(const FigureRecipe& recipe, Extent extent, const fs::path& folder,
             const std::map<std::string, JobOutcome>& runs) {
  Outcome outcome{recipe, {}, {}};
  for (const Job& job : recipe.jobs(extent))
    if (!runs.at(job.name).ok())
      outcome.failure += fmt::format("run {}: {}\n", job.name, runs.at(job.name).message);
  if (!outcome.failure.empty()) return outcome;
  outcome.made = recipe.make(Runs(folder / "runs"), extent);
  const std::string data = figure_csv(outcome.made.figure);
  if (!data.empty()) replace_file(folder / fmt::format("{}.csv", recipe.name), data);
  write_figure(outcome.made.figure, folder / std::string(recipe.name));
  return outcome;
}

std::string heading(const FigureRecipe& recipe) {
  const bool of_paper = std::ranges::all_of(recipe.number, [](char c) { return c >= '0' && c <= '9'; });
  return of_paper ? fmt::format("Fig {}: {}", recipe.number, recipe.title) : std::string(recipe.title);
}

json row_json(const Comparison& row) {
  return {{"what", row.what},       {"paper", row.paper}, {"ours", row.ours}, {"difference", row.difference},
          {"samples", row.samples}, {"why", row.why}};
}

json reproduction_json(std::span<const Outcome> outcomes, Extent extent, const std::string& command) {
  json figures = json::array();
  for (const auto& outcome : outcomes) {
    json rows = json::array();
    for (const auto& row : outcome.made.rows) rows.push_back(row_json(row));
    const std::string name(outcome.recipe.name);
    figures.push_back({{"name", name},
                       {"title", heading(outcome.recipe)},
                       {"caption", outcome.made.caption},
                       {"failure", outcome.failure.empty() ? json(nullptr) : json(outcome.failure)},
                       {"png", outcome.failure.empty() ? json(name + ".png") : json(nullptr)},
                       {"rows", std::move(rows)}});
  }
  return {{"command", command},
          {"extent", extent == Extent::full ? "full" : "quick"},
          {"made", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))},
          {"version", version()},
          {"git_hash", git_revision()},
          {"git_dirty", has_local_changes()},
          {"figures", std::move(figures)}};
}

// The rows of all figures as a Markdown table.
std::string results_markdown(const json& reproduction) {
  std::string text =
      fmt::format("Made by `{}` on {}, revision {}{}.\n\n", reproduction["command"].get<std::string>(),
                  reproduction["made"].get<std::string>(), reproduction["git_hash"].get<std::string>(),
                  reproduction["git_dirty"].get<bool>() ? " with changes" : "");
  text += "| figure | what | paper | ours | difference | samples |\n|---|---|---|---|---|---|\n";
  for (const auto& figure : reproduction["figures"]) {
    const std::string title = figure["title"];
    for (const auto& row : figure["rows"])
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", title.substr(0, title.find(':')),
                          row["what"].get<std::string>(), row["paper"].get<std::string>(),
                          row["ours"].get<std::string>(), row["difference"].get<std::string>(),
                          row["samples"].get<std::string>());
  }
  return text;
}

std::string rows_html(const json& rows) {
  std::string html =
      "<div class=\"table\"><table><thead><tr><th>what</th><th>paper</th><th>ours</th><th>difference</th>"
      "<th>samples</th><th>why</th></tr></thead><tbody>\n";
  for (const auto& row : rows) {
    html += "<tr>";
    for (const char* column : {"what", "paper", "ours", "difference", "samples", "why"})
      html += fmt::format("<td>{}</td>", html_escape(row[column].get<std::string>()));
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string index_html(const json& reproduction, const fs::path& folder) {
  std::string body = fmt::format(
      "<h1>Nash and Panfilov 2004, reproduced</h1>\n<p><code>{}</code>, {}, myowave {} ({}{})</p>\n",
      html_escape(reproduction["command"].get<std::string>()), reproduction["made"].get<std::string>(),
      version(), git_revision(), has_local_changes() ? " with changes" : "");
  for (const auto& figure : reproduction["figures"]) {
    const std::string name = figure["name"];
    body += fmt::format("<section id=\"{0}\"><h2>{1}</h2>\n", name,
                        html_escape(figure["title"].get<std::string>()));
    if (!figure["failure"].is_null()) {
      body += fmt::format("<p class=\"warning\">Not made. {}</p></section>\n",
                          html_escape(figure["failure"].get<std::string>()));
      continue;
    }
    body += fmt::format("<figure><img alt=\"{}\" src=\"{}\"><figcaption>{}</figcaption></figure>\n",
                        html_escape(figure["title"].get<std::string>()), data_uri(folder / (name + ".png")),
                        html_escape(figure["caption"].get<std::string>()));
    if (!figure["rows"].empty()) body += rows_html(figure["rows"]);
    body += fmt::format(
        "<p>Files: <a href=\"{0}.svg\">{0}.svg</a>{1}</p></section>\n", name,
        fs::exists(folder / (name + ".csv")) ? fmt::format(", <a href=\"{0}.csv\">{0}.csv</a>", name) : "");
  }
  return html_page("Nash and Panfilov 2004, reproduced", body);
}

void print_rows(const Outcome& outcome) {
  fmt::print("{}\n", heading(outcome.recipe));
  if (!outcome.failure.empty()) fmt::print("  not made: {}", outcome.failure);
  for (const auto& row : outcome.made.rows) {
    fmt::print("  {}\n    ours {}", row.what, row.ours);
    if (!row.paper.empty()) fmt::print("; paper {}", row.paper);
    if (!row.difference.empty()) fmt::print("; {}", row.difference);
    fmt::print("\n");
  }
}

}  // namespace

std::vector<FigureRecipe> choose_figures(const std::vector<std::string>& numbers) {
  const auto recipes = figure_recipes();
  if (numbers.empty() || std::ranges::find(numbers, "all") != numbers.end())
    return {recipes.begin(), recipes.end()};
  std::vector<std::string_view> known;
  std::string all;
  for (const auto& recipe : recipes) {
    known.push_back(recipe.number);
    all += fmt::format("{}, ", recipe.number);
  }
  for (const auto& number : numbers) {
    if (std::ranges::find(known, number) != known.end()) continue;
    const std::string meant = did_you_mean(number, known);
    throw solver::InputError(
        fmt::format("there is no figure \"{}\"{}; figures: {}all", number, hint(meant), all));
  }
  std::vector<FigureRecipe> chosen;
  for (const auto& recipe : recipes)
    if (std::ranges::find(numbers, recipe.number) != numbers.end()) chosen.push_back(recipe);
  return chosen;
}

std::string figure_csv(const Figure& figure) {
  std::string text;
  for (std::size_t panel = 0; panel < figure.panels.size(); ++panel) {
    const auto* plot = std::get_if<Plot>(&figure.panels[panel]);
    if (plot == nullptr) continue;
    for (const Series& series : plot->series)
      for (std::size_t n = 0; n < series.x.size(); ++n) {
        if (!std::isfinite(series.x[n]) || !std::isfinite(series.y[n])) continue;
        text +=
            fmt::format("{},\"{}\",\"{}\",{:.8g},{:.8g},{}\n", panel, plot->title, series.name, series.x[n],
                        series.y[n], n < series.error.size() ? fmt::format("{:.8g}", series.error[n]) : "");
      }
  }
  return text.empty() ? "" : "panel,title,series,x,y,error\n" + text;
}

void reproduce(std::span<const FigureRecipe> recipes, Extent extent, const fs::path& folder, int parallel,
               const std::string& command) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw solver::InputError(
        fmt::format("cannot make the result folder {}: {}", folder.string(), error.message()));
  const auto start = std::chrono::steady_clock::now();
  const auto runs = run_all(jobs_of(recipes, extent), folder, parallel);
  std::vector<Outcome> outcomes;
  for (const auto& recipe : recipes) {
    outcomes.push_back(make(recipe, extent, folder, runs));
    print_rows(outcomes.back());
  }
  const json reproduction = reproduction_json(outcomes, extent, command);
  replace_file(folder / "reproduction.json", reproduction.dump(2) + '\n');
  replace_file(folder / "results.md", results_markdown(reproduction));
  replace_file(folder / "index.html", index_html(reproduction, folder));
  fmt::print("{} figures in {:.0f} s; {}\n", outcomes.size(),
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
             (folder / "index.html").string());
  const auto failed = std::ranges::count_if(outcomes, [](const Outcome& o) { return !o.failure.empty(); });
  if (failed > 0)
    throw solver::NumericalFailure(
        fmt::format("{} of {} figures were not made: their runs failed; what each said is in {}", failed,
                    outcomes.size(), (folder / "runs").string()));
}

}  // namespace myowave::apps
