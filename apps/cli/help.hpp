// `myowave help TOPIC`: sections of the documentation, compiled in.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace myowave::apps {

struct HelpTopic {
  std::string_view name;     // "sweeps"
  std::string_view words;    // what it tells, a line
  std::string_view file;     // name in embedded_file()
  std::string_view heading;  // "## Sweeps" without the hashes; empty: the whole file
};

std::span<const HelpTopic> help_topics();

// The text of a section of Markdown, its subsections included, without the targets of links. Empty where
// there is no such heading.
std::string section_of(std::string_view markdown, std::string_view heading);

// The names of all topics, a line each with what they tell.
std::string topic_names();

// Errors: InputError where there is no such topic, with the nearest one.
std::string help_text(std::string_view topic);

}  // namespace myowave::apps
