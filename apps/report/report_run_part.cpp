// A run's part of report.html.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "apps/base/memory.hpp"
#include "apps/base/page.hpp"
#include "apps/report/report_html.hpp"
#include "apps/report/report_parts.hpp"
#include "apps/report/report_sheet.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

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
  std::string html = "<h3>What was modelled</h3>\n" + html_table({}, modelled);
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
         (rows.empty() ? "<p>None.</p>\n" : html_table({"key", "value", "default", "unit", "meaning"}, rows));
}

std::string numbers_html(const ReportRun& run) {
  std::vector<std::vector<std::string>> rows;
  for (const Fact& fact : run.numbers()) rows.push_back({html_escape(fact.what), html_escape(fact.value)});
  return rows.empty() ? "" : "<h3>Numbers</h3>\n" + html_table({}, rows);
}

// Of each of Kokkos' memory spaces, as far as the summary has them.
void add_memory(std::vector<std::vector<std::string>>& rows, const json& summary) {
  const auto spaces_of = [&](const char* which) {
    const json::json_pointer at(fmt::format("/memory/{}", which));
    return summary.contains(at) && summary[at].is_object() ? summary[at] : json::object();
  };
  const json allocated = spaces_of("most_bytes"), estimated = spaces_of("planned_bytes");
  json spaces = estimated;
  spaces.update(allocated);
  for (const auto& [space, any] : spaces.items()) {
    std::string words;
    for (const auto& [bytes, what] : {std::pair{&allocated, "allocated"}, {&estimated, "estimated"}}) {
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
  std::string html = "<h3>Timings and memory</h3>\n" + html_table({"phase", "time", "share"}, rows);
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

}  // namespace

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

}  // namespace myowave::apps
