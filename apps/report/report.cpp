#include "apps/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <set>

#include "apps/base/embedded_files.hpp"
#include "apps/draw/figure.hpp"
#include "apps/paper/measures.hpp"
#include "apps/base/file_io.hpp"
#include "apps/base/memory.hpp"
#include "apps/report/movie.hpp"
#include "apps/base/page.hpp"
#include "apps/report/report_run.hpp"
#include "apps/report/report_sheet.hpp"
#include "apps/report/report_sweep.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// Of all sheets together, before base64, which makes a page of 15 MB at most.
constexpr std::size_t bytes_of_sheets = 10'000'000;

// JSON that stands in a script element: no tag can end it.
std::string script_json(const std::string& text) {
  std::string result;
  for (const char letter : text) letter == '<' ? result += "\\u003c" : result += letter;
  return result;
}

std::string dumped(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

// Numbers and lists as they are, text without its quotes.
std::string plain(const json& value) {
  if (value.is_null()) return "–";
  return html_escape(value.is_string() ? value.get<std::string>() : dumped(value));
}

// `words` between backticks are code.
std::string doc_html(const std::string& doc) {
  std::string html;
  bool code = false;
  for (const char letter : html_escape(doc)) {
    if (letter != '`') {
      html += letter;
      continue;
    }
    html += code ? "</code>" : "<code>";
    code = !code;
  }
  return html;
}

std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"scroll\"><table>";
  if (!head.empty()) {
    html += "<thead><tr>";
    for (const auto& cell : head) html += fmt::format("<th scope=\"col\">{}</th>", cell);
    html += "</tr></thead>";
  }
  html += "<tbody>\n";
  for (const auto& row : rows) {
    for (std::size_t n = 0; n < row.size(); ++n)
      html +=
          n == 0 ? fmt::format("<tr><th scope=\"row\">{}</th>", row[n]) : fmt::format("<td>{}</td>", row[n]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string model_html(const ReportRun& run) {
  const json& summary = run.results().summary();
  if (!summary.is_object() || !summary.contains("plan")) return "";
  std::vector<std::vector<std::string>> modelled;
  std::string left_out;
  for (const auto& part : summary["plan"]) {
    if (part.value("active", false))
      modelled.push_back({plain(part["part"]), plain(part["what"])});
    else
      left_out += fmt::format("<li>{}: {}</li>", plain(part["part"]), plain(part["why"]));
  }
  std::string html = "<h3>What was modelled</h3>\n" + table({}, modelled);
  if (!left_out.empty())
    html += fmt::format("<p class=\"faint\">Not modelled:</p><ul class=\"faint\">{}</ul>\n", left_out);
  return html;
}

std::string parameters_html(const ReportRun& run) {
  if (!run.configuration().is_object()) return "";
  std::vector<std::vector<std::string>> rows;
  for (const auto& one : run.changed_parameters()) {
    rows.push_back({fmt::format("<code>{}</code>", html_escape(one.key)), plain(one.value),
                    plain(one.by_default), html_escape(one.unit), doc_html(one.doc)});
  }
  const std::string heading = "<h3>Parameters that differ from the defaults</h3>\n";
  return heading +
         (rows.empty() ? "<p>None.</p>\n" : table({"key", "value", "default", "unit", "meaning"}, rows));
}

std::string numbers_html(const ReportRun& run) {
  std::vector<std::vector<std::string>> rows;
  for (const Fact& fact : run.numbers()) rows.push_back({html_escape(fact.what), html_escape(fact.value)});
  return rows.empty() ? "" : "<h3>Numbers</h3>\n" + table({}, rows);
}

// Of each of Kokkos' memory spaces, as far as the summary has them.
void add_memory(std::vector<std::vector<std::string>>& rows, const json& summary) {
  const auto spaces_of = [&](const char* which) {
    const json::json_pointer at(fmt::format("/memory/{}", which));
    return summary.contains(at) && summary[at].is_object() ? summary[at] : json::object();
  };
  const json allocated = spaces_of("most_bytes"), foretold = spaces_of("planned_bytes");
  json spaces = foretold;
  spaces.update(allocated);
  for (const auto& [space, any] : spaces.items()) {
    std::string words;
    for (const auto& [bytes, what] : {std::pair{&allocated, "allocated"}, {&foretold, "foretold"}}) {
      const json number = bytes->value(space, json());
      if (!number.is_number_integer()) continue;
      words += fmt::format("{}{} {}", words.empty() ? "" : ", ", bytes_text(number), what);
    }
    rows.push_back({fmt::format("memory, {}", html_escape(space)), words, ""});
  }
}

std::string timings_html(const ReportRun& run) {
  const json& summary = run.results().summary();
  if (!summary.is_object() || !summary.contains("phases") || !summary["wall_s"].is_number()) return "";
  const double wall = summary["wall_s"];
  std::vector<std::vector<std::string>> rows;
  for (const auto& [phase, seconds] : summary["phases"].items()) {
    if (!seconds.is_number()) continue;
    const double s = seconds;
    rows.push_back({html_escape(phase), fmt::format("{:.3g} s", s),
                    fmt::format("{:.1f} %", wall > 0 ? 100 * s / wall : 0)});
  }
  rows.push_back({"whole run", fmt::format("{:.3g} s", wall), ""});
  if (const auto at = "/throughput/cell_steps_per_s"_json_pointer;
      summary.contains(at) && summary[at].is_number())
    rows.push_back({"throughput",
                    fmt::format("{:.3g} million cell steps a second", 1e-6 * summary[at].get<double>()), ""});
  add_memory(rows, summary);
  std::string html = "<h3>Timings and memory</h3>\n" + table({"phase", "time", "share"}, rows);
  if (const json mechanics = summary.value("mechanics", json()); mechanics.is_object()) {
    std::string counts;
    for (const auto& [name, value] : mechanics.items()) {
      if (value.is_null()) continue;
      std::string words = name;
      std::ranges::replace(words, '_', ' ');
      counts +=
          fmt::format("{}{} {}", counts.empty() ? "" : ", ", html_escape(words),
                      value.is_number_float() ? fmt::format("{:.3g}", value.get<double>()) : plain(value));
    }
    html += fmt::format("<p class=\"faint\">Mechanics: {}.</p>\n", counts);
  }
  return html;
}

std::string words_html(const ReportRun& run) {
  std::string html;
  const json& summary = run.results().summary();
  if (summary.is_object()) {
    if (summary.contains("failure") && summary["failure"].is_string())
      html += fmt::format("<p class=\"warning\">The run failed: {}</p>\n", plain(summary["failure"]));
    for (const auto& warning : summary.value("warnings", json::array()))
      html += fmt::format("<p class=\"warning\">Warning: {}</p>\n", plain(warning));
  }
  for (const auto& note : run.notes()) html += fmt::format("<p class=\"note\">{}</p>\n", html_escape(note));
  return html;
}

std::string sheet_html(const PackedSheet& sheet, const ReportRun& run) {
  const std::string heading = "<h3>V on the sheet</h3>\n";
  if (sheet.frames == 0)
    return heading +
           "<p class=\"note\">There are no frames: the run wrote no fields.h5 (output.fields = true).</p>\n";
  std::string caption =
      "From light (rest, V = 0) to dark (excited, V = 1); lines: elements; dots: phase singularities, "
      "with the path of the last 60 t.u.";
  if (sheet.frames < sheet.stored_frames)
    caption += fmt::format(" {} of {} frames.", sheet.frames, sheet.stored_frames);
  return fmt::format(R"({}<figure class="sheet">
<canvas width="640" height="640" role="img" aria-label="V on the sheet of {}"></canvas>
<div class="controls no-print">
<button type="button" class="play" aria-label="Play">▶</button>
<input type="range" class="time" min="0" max="{}" value="0" step="1" aria-label="Time">
<output></output>
<label><input type="checkbox" class="lines" checked> elements</label>
<label><input type="checkbox" class="tips" checked> tips</label>
</div>
<figcaption>{}</figcaption>
<script type="application/json">{}</script>
<script type="text/plain" class="V">{}</script>
<script type="text/plain" class="nodes">{}</script>
</figure>
<noscript><p class="note">The frames and the interactive curves need JavaScript.</p></noscript>
)",
                     heading, html_escape(run.name()), sheet.frames - 1, html_escape(caption),
                     script_json(sheet.json), sheet.V, sheet.nodes);
}

// Writes each plot into the folder and shows it.
std::string plots_html(const std::vector<NamedPlot>& plots, const fs::path& folder,
                       const std::string& prefix) {
  if (plots.empty()) return "";
  fs::create_directories(folder);
  std::string html = "<div class=\"plots\">\n";
  for (const NamedPlot& one : plots) {
    const Figure figure{.title = "", .panels = {one.plot}};
    const fs::path stem = folder / (prefix + one.name);
    write_figure(figure, stem);
    const std::string file = html_escape(folder.filename().string() + "/" + stem.filename().string());
    html += fmt::format(
        "<figure class=\"curves\"><img class=\"plot\" alt=\"{0}: {1} against {2}\" src=\"{3}\">\n"
        "<script type=\"application/json\">{4}</script>\n"
        "<figcaption>{5} <a href=\"{6}.svg\">SVG</a> <a href=\"{6}.png\">PNG</a></figcaption></figure>\n",
        html_escape(one.plot.title), html_escape(one.plot.y.label), html_escape(one.plot.x.label),
        "data:image/svg+xml;base64," + base64(figure_svg(figure)), script_json(dumped(plot_json(one.plot))),
        html_escape(one.caption), file);
  }
  return html + "</div>\n";
}

std::string origin_html(const ReportRun& run) {
  const nlohmann::json& manifest = run.manifest();
  if (!manifest.is_object()) return "";
  const auto text = [&](const char* pointer) {
    return html_escape(manifest.value(nlohmann::json::json_pointer(pointer), std::string("?")));
  };
  return fmt::format("<p class=\"faint\">{} · myowave {} ({}) · {} · {}</p>\n", text("/started"),
                     text("/program/version"), text("/program/git_hash"), text("/backend/name"),
                     text("/machine/processor"));
}

std::string run_html(const ReportRun& run, const fs::path& plots, const std::string& prefix,
                     std::size_t bytes) {
  PackedSheet sheet;
  std::string broken;
  try {
    sheet = pack_sheet(run, bytes);
  } catch (const std::runtime_error& error) {  // a file that its run left in pieces
    broken = fmt::format("<p class=\"note\">fields.h5 cannot be read: {}</p>\n", html_escape(error.what()));
  }
  return origin_html(run) + words_html(run) + "<div class=\"facts\"><div>" +
         (broken.empty() ? sheet_html(sheet, run) : broken) + "</div><div>" + numbers_html(run) +
         timings_html(run) + "</div></div>\n<h3>Curves</h3>\n" + plots_html(run.plots(), plots, prefix) +
         parameters_html(run) + model_html(run);
}

// Whether two runs differ in their periods and in their numbers of sources: the unpaired t-test, and one that
// knows how many independent samples there are.
std::string tests_html(const ReportRun& first, const ReportRun& second) {
  const auto has = [&](const char* file) {
    return fs::exists(first.results().folder() / file) && fs::exists(second.results().folder() / file);
  };
  std::vector<Comparison> tests;
  if (has("beats.csv")) {
    const auto periods = [](const ReportRun& run) {
      const nlohmann::json configuration = run.configuration();
      const double from = configuration.is_object()
                              ? configuration.value(nlohmann::json::json_pointer("/output/period_from"), 0.0)
                              : 0.0;
      return all_periods(periods_of(run.results(), from));
    };
    tests.push_back(test_row("period (t.u.)", "", periods(first), periods(second)));
  }
  if (has("sources.csv")) {
    const auto sources = [](const ReportRun& run) {
      return run.results().csv("sources.csv").numbers("sources");
    };
    tests.push_back(test_row("tips", "", sources(first), sources(second)));
  }
  std::vector<std::vector<std::string>> rows;
  for (const Comparison& test : tests)
    rows.push_back({html_escape(test.what), html_escape(test.ours), html_escape(test.samples)});
  return rows.empty() ? "" : table({"first less second run", "difference of means", "samples"}, rows);
}

// A column a run, a row a number that differs in its parameters or that was found.
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
  return "<h2>Side by side</h2>\n" + table(head, rows) +
         (runs.size() == 2 ? tests_html(runs[0], runs[1]) : "");
}

std::string reproduction_html(const fs::path& folder) {
  std::ifstream file(folder / "reproduction.json");
  json all;
  try {
    all = json::parse(file);
  } catch (const json::exception& error) {
    throw solver::InputError(fmt::format("{}: {}", (folder / "reproduction.json").string(), error.what()));
  }
  std::string html;
  for (const auto& figure : all.value("figures", json::array())) {
    html += fmt::format("<h3>{}</h3>\n", plain(figure.value("title", json())));
    if (figure.value("failure", json()).is_string())
      html += fmt::format("<p class=\"warning\">Not made: {}</p>\n", plain(figure["failure"]));
    if (figure.value("png", json()).is_string()) {
      const fs::path png = folder / figure["png"].get<std::string>();
      html += fs::exists(png) ? fmt::format(
                                    "<figure><img class=\"plot\" alt=\"{}\" "
                                    "src=\"{}\"><figcaption>{}</figcaption></figure>\n",
                                    plain(figure.value("title", json())), data_uri(png),
                                    figure.contains("caption") ? plain(figure["caption"]) : "")
                              : fmt::format("<p class=\"note\">There is no {}.</p>\n",
                                            html_escape(png.filename().string()));
    }
    std::vector<std::vector<std::string>> rows;
    for (const auto& row : figure.value("rows", json::array())) {
      rows.emplace_back();
      for (const char* column : {"what", "paper", "ours", "difference", "samples", "why"})
        rows.back().push_back(row.contains(column) ? plain(row[column]) : "–");
    }
    if (!rows.empty()) html += table({"what", "paper", "ours", "difference", "samples", "why"}, rows);
  }
  return html;
}

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
             "<h3>Pairs from the same state</h3>\n<p>How the first break-up of the {0} run compares with "
             "that "
             "of the {1} one. Never: the {0} run was still whole when the {1} one had broken up, and stayed "
             "so "
             "to its end. Undecided: neither broke up while both ran.</p>\n",
             html_escape(names[1]), html_escape(names[0])) +
         table(
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
  return "<h3>Runs and costs</h3>\n" + table({}, rows);
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
  return rows.empty() ? "" : "<h3>Table</h3>\n" + table(head, rows);
}

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
