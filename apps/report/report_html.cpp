#include "apps/report/report_html.hpp"

#include <fmt/format.h>

#include "apps/base/page.hpp"
#include "apps/draw/figure.hpp"

namespace myowave::apps {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

std::string script_json(const std::string& text) {
  std::string result;
  for (const char letter : text) letter == '<' ? result += "\\u003c" : result += letter;
  return result;
}

std::string dumped(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string plain(const json& value) {
  if (value.is_null()) return "–";
  return html_escape(value.is_string() ? value.get<std::string>() : dumped(value));
}

std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows) {
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

}  // namespace myowave::apps
