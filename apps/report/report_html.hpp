// Pieces of HTML that the parts of report.html share.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/report/report_run.hpp"

namespace myowave::apps {

// JSON that stands in a script element: no tag can end it.
std::string script_json(const std::string& text);

// On one line; bytes that are no UTF-8 become U+FFFD.
std::string dumped(const nlohmann::ordered_json&);

// Numbers and lists as they are, text without its quotes, null as a dash; escaped.
std::string plain(const nlohmann::ordered_json&);

// Cells are HTML. The first of each row is its heading; `head` may be empty.
std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows);

// Writes each plot into the folder as PREFIX_NAME.png and .svg, and shows it.
// Errors: std::runtime_error "cannot write FILE: reason".
std::string plots_html(const std::vector<NamedPlot>&, const std::filesystem::path& folder,
                       const std::string& prefix);

}  // namespace myowave::apps
