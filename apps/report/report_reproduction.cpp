// A reproduction's part of report.html.
#include <fmt/format.h>

#include <fstream>

#include "apps/base/page.hpp"
#include "apps/report/report_html.hpp"
#include "apps/report/report_parts.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

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
    if (!rows.empty()) html += html_table({"what", "paper", "ours", "difference", "samples", "why"}, rows);
  }
  return html;
}

}  // namespace myowave::apps
