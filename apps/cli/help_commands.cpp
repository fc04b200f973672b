// `myowave describe` and `myowave help`: what the program knows about itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include "apps/cli/commands.hpp"
#include "apps/cli/help.hpp"
#include "apps/input/schema.hpp"

namespace myowave::apps {

void add_describe(CLI::App& app) {
  struct Options {
    std::string section;
    bool markdown = false;
  };
  CLI::App* const command = app.add_subcommand("describe", "Print the reference of scene files");
  const auto options = std::make_shared<Options>();
  command->add_option("SECTION", options->section, "Only this section, for example mechanics");
  command->add_flag("--markdown", options->markdown,
                    "All sections as the Markdown tables of apps/input/REFERENCE.md");
  command->callback(
      [options] { std::cout << (options->markdown ? describe_markdown() : describe(options->section)); });
}

void add_help(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("help", "Explain a topic, or the options of a subcommand");
  const auto topic = std::make_shared<std::string>();
  command->add_option("TOPIC", *topic, "One of the topics below, or a subcommand");
  command->footer(topic_names());
  command->callback([topic, &app] {
    if (topic->empty()) {
      // app.help() would print the help of the subcommand `help`.
      fmt::print("{}\n{}", app.get_formatter()->make_help(&app, "myowave", CLI::AppFormatMode::Normal),
                 topic_names());
      return;
    }
    // Some commands are topics too.
    const auto commands = app.get_subcommands([](const CLI::App*) { return true; });
    const auto found = std::ranges::find(commands, *topic, &CLI::App::get_name);
    const CLI::App* const subcommand = found == commands.end() ? nullptr : *found;
    if (subcommand != nullptr) fmt::print("{}", subcommand->help("myowave"));
    if (is_topic(*topic) || subcommand == nullptr) fmt::print("{}", help_text(*topic));
  });
}

}  // namespace myowave::apps
