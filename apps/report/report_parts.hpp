// The parts of report.html, each as HTML.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/report/report_run.hpp"

namespace myowave::apps {

// A run. Its plots go into the folder `plots`, as files that start with `prefix`; its packed frames take at
// most `bytes`, before base64.
std::string run_html(const ReportRun&, const std::filesystem::path& plots, const std::string& prefix,
                     std::size_t bytes);

// Several runs side by side: a column a run, a row a number that differs in its parameters or that was found.
std::string comparison_html(const std::vector<ReportRun>&);

// A sweep's folder. Errors: as of read_table.
std::string sweep_html(const std::filesystem::path& folder, const std::filesystem::path& plots,
                       const std::string& prefix);

// The figures and rows of a folder of `myowave reproduce`.
// Errors: InputError where its reproduction.json cannot be read.
std::string reproduction_html(const std::filesystem::path& folder);

}  // namespace myowave::apps
