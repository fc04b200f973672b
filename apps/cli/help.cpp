#include "apps/cli/help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <regex>
#include <vector>

#include "apps/base/embedded_files.hpp"
#include "apps/input/schema.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

constexpr std::array topics = {
    HelpTopic{"tutorial", "from the first spiral to a sweep and its report, in ten minutes", "tutorial.md",
              ""},
    HelpTopic{"scene", "scene files, and values on the command line", "apps.md", "A scene"},
    HelpTopic{"units", "of time, length, stress and V", "apps.md", "Units"},
    HelpTopic{"results", "the files that a run leaves", "apps.md", "What a run leaves in its folder"},
    HelpTopic{"report", "one page of runs", "apps.md", "The report"},
    HelpTopic{"accuracy", "presets, and what they cost in time and error", "myowave.md",
              "Accuracy and speed"},
    HelpTopic{"tradeoff", "measuring cost against error of your own scene", "apps.md", "Cost against error"},
    HelpTopic{"plan", "what a scene requires and what is left out", "apps.md", "Only what a scene requires"},
    HelpTopic{"stability", "where steps and solves are right, wrong or fail", "solver.md", "Stability"},
    HelpTopic{"sweeps", "many runs, their table, several machines", "apps.md", "Sweeps"},
    HelpTopic{"checkpoints", "stopping a run and going on with it", "apps.md", "Checkpoints"},
    HelpTopic{"faults", "what is lost when something breaks", "apps.md", "Faults"},
    HelpTopic{"figures", "the paper's figures", "apps.md", "The paper's figures"},
    HelpTopic{"backends", "where it runs, and how it was tried", "myowave.md", "Backends"},
};

// Number of hashes that a line begins with, as a heading; else 0.
std::size_t heading_level(std::string_view line) {
  const std::size_t hashes = std::min(line.find_first_not_of('#'), line.size());
  return hashes > 0 && line.substr(hashes).starts_with(' ') ? hashes : 0;
}

}  // namespace

std::span<const HelpTopic> help_topics() { return topics; }

std::string section_of(std::string_view markdown, std::string_view heading) {
  std::string text;
  std::size_t level = 0;  // of the section, once it has begun
  bool code = false;      // where a line with a hash is none of the document's
  while (!markdown.empty()) {
    const std::size_t end = std::min(markdown.find('\n'), markdown.size() - 1) + 1;
    const std::string_view line = markdown.substr(0, end);
    markdown.remove_prefix(end);
    if (line.starts_with("```")) code = !code;
    const std::size_t own = code ? 0 : heading_level(line);
    if (own > 0 && level > 0 && own <= level) break;
    if (own > 0 && level == 0 && line.substr(own + 1, line.find_last_not_of('\n') - own) == heading)
      level = own;
    if (level > 0 && !line.starts_with("<!--") && !line.starts_with("![")) text += line;
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
  const std::string_view file = embedded_file(found->file);
  return found->heading.empty() ? std::string(file) : section_of(file, found->heading);
}

}  // namespace myowave::apps
