// `myowave report`.
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/cli/commands.hpp"
#include "apps/report/report.hpp"

namespace myowave::apps {

void add_report(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("report", "Make one HTML page about runs");
  const auto request = std::make_shared<ReportRequest>();
  command->add_option("DIR", request->folders, "Folders of runs, of sweeps, or of a reproduction")
      ->required();
  command->add_option("--out", request->out, "The page; default: report.html in the first folder")
      ->type_name("FILE");
  command->add_flag("--movie", request->movie, "Also movie.mp4 of each run, by ffmpeg where it is installed");
  command->callback([request] { report(*request); });
}

}  // namespace myowave::apps
