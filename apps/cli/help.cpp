#include "apps/cli/help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>
#include <vector>

#include "apps/base/embedded_files.hpp"
#include "apps/input/did_you_mean.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

constexpr std::array topics = {
    HelpTopic{"tutorial", "from the first spiral to a sweep and its report, in ten minutes",
              "apps/cli/tutorial.md", ""},
    HelpTopic{"commands", "all commands, a scene by example, where the results are", "apps/README.md", ""},
    HelpTopic{"usage", "all options, exit statuses, error messages", "apps/cli/README.md", ""},
    HelpTopic{"model", "the equations", "solver/MODEL.md", ""},
    HelpTopic{"breakup", "what break-up and death of a spiral mean", "README.md", "What break-up means here"},
    HelpTopic{"units", "of time, length, stress and V", "apps/README.md", "Units"},
    HelpTopic{"scene", "scene files, values on the command line, presets", "apps/input/README.md", ""},
    HelpTopic{"start", "initial states", "apps/input/README.md", "Initial states"},
    HelpTopic{"results", "the files that a run writes", "apps/results/README.md", "Files of a run"},
    HelpTopic{"checkpoints", "stopping and resuming a run", "apps/results/README.md", "Checkpoints"},
    HelpTopic{"plan", "which parts of the model a scene needs", "apps/results/README.md",
              "Only what a scene needs"},
    HelpTopic{"report", "one HTML page about runs", "apps/report/README.md", ""},
    HelpTopic{"sweeps", "many runs, their table", "apps/sweep/README.md", ""},
    HelpTopic{"records", "the files of a sweep", "apps/sweep/RECORDS.md", ""},
    HelpTopic{"slurm", "a sweep on several machines", "apps/sweep/README.md", "Several machines"},
    HelpTopic{"faults", "what is lost when something breaks", "apps/sweep/FAULTS.md", ""},
    HelpTopic{"scenes", "the scenes and sweeps that come with the program", "apps/scenes/README.md", ""},
    HelpTopic{"accuracy", "presets: their speed and their error", "apps/tradeoff/ACCURACY.md", ""},
    HelpTopic{"tradeoff", "time against error for your own scene", "apps/tradeoff/README.md", ""},
    HelpTopic{"stability", "which steps and loads are right, wrong or fail", "apps/stability/README.md", ""},
    HelpTopic{"figures", "the figures of the paper", "apps/paper/README.md", ""},
    HelpTopic{"backends", "where it runs, and what was tried", "README.md", "Backends"},
};

// Sections that are of no use on a terminal: they describe source files.
constexpr std::array about_sources = {std::string_view("Files"), std::string_view("Rooms")};

// The number of hashes at the start of a heading; 0 for any other line.
std::size_t heading_level(std::string_view line) {
  const std::size_t hashes = std::min(line.find_first_not_of('#'), line.size());
  return hashes > 0 && line.substr(hashes).starts_with(' ') ? hashes : 0;
}

}  // namespace

std::span<const HelpTopic> help_topics() { return topics; }

bool is_topic(std::string_view name) {
  return std::ranges::find(topics, name, &HelpTopic::name) != topics.end();
}

std::string section_of(std::string_view markdown, std::string_view heading) {
  std::string text;
  std::size_t level = heading.empty() ? 1 : 0;  // of the section that is being read
  std::size_t left_out = 0;                     // level of the section within it that is left out
  bool code = false;                            // a line with a hash there is no heading
  while (!markdown.empty()) {
    const std::size_t end = std::min(markdown.find('\n'), markdown.size() - 1) + 1;
    const std::string_view line = markdown.substr(0, end);
    markdown.remove_prefix(end);
    if (line.starts_with("```")) code = !code;
    const std::size_t own = code ? 0 : heading_level(line);
    if (own > 0) {
      const std::string_view title = line.substr(own + 1, line.find_last_not_of('\n') - own);
      if (level > 0 && !heading.empty() && own <= level) break;
      if (level == 0 && title == heading) level = own;
      if (own <= left_out) left_out = 0;
      if (own > level && std::ranges::find(about_sources, title) != about_sources.end()) left_out = own;
    }
    if (level > 0 && left_out == 0 && !line.starts_with("<!--") && !line.starts_with("![")) text += line;
  }
  static const std::regex link(R"(\[([^\]]+)\]\([^)]+\))");
  return std::regex_replace(text, link, "$1");
}

std::string topic_names() {
  std::string text = "Topics:\n";
  for (const HelpTopic& topic : topics) text += fmt::format("  {:<14}{}\n", topic.name, topic.words);
  return text;
}

std::string help_text(std::string_view topic) {
  const auto* const found = std::ranges::find(topics, topic, &HelpTopic::name);
  if (found == topics.end()) {
    std::vector<std::string_view> names;
    for (const HelpTopic& one : topics) names.push_back(one.name);
    const std::string meant = did_you_mean(topic, names);
    throw solver::InputError(
        fmt::format("myowave: there is no help on \"{}\"{}\n{}", topic, hint(meant), topic_names()));
  }
  return section_of(embedded_file(found->file), found->heading);
}

}  // namespace myowave::apps
