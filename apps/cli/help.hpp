// `myowave help TOPIC`: sections of the documentation, compiled into the program.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace myowave::apps {

struct HelpTopic {
  std::string_view name;     // "sweeps"
  std::string_view words;    // what it is about, one line
  std::string_view file;     // name in embedded_file()
  std::string_view heading;  // "## Sweeps" without the hashes; empty: the whole file
};

std::span<const HelpTopic> help_topics();
bool is_topic(std::string_view name);

// The text of a section of Markdown with its subsections; the whole text for an empty heading. Without
// comments, pictures, targets of links and, below the title, the sections on source files (`Files`, `Rooms`).
// Empty if there is no such heading.
std::string section_of(std::string_view markdown, std::string_view heading);

// The names of all topics with what they are about, one line each.
std::string topic_names();

// Errors: InputError if there is no such topic, with the nearest name.
std::string help_text(std::string_view topic);

}  // namespace myowave::apps
