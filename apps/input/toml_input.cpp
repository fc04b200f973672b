#include "apps/input/toml_input.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>

#include "apps/input/did_you_mean.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {

using solver::InputError;

bool is_override(const toml::source_region& where) {
  return where.path && where.path->starts_with(override_mark);
}

void Problems::add(const toml::source_region& where, const std::string& message) {
  if (is_override(where)) {
    lines_.emplace(true, 0, 0, fmt::format("{}: {}", *where.path, message));
  } else if (where.begin) {
    lines_.emplace(false, where.begin.line, where.begin.column,
                   fmt::format("{}:{}:{}: {}", file_, where.begin.line, where.begin.column, message));
  } else {
    lines_.emplace(false, 0, 0, fmt::format("{}: {}", file_, message));
  }
}

void Problems::add_override(std::string_view key, const std::string& message) {
  lines_.emplace(true, 0, 0, fmt::format("{}{}: {}", override_mark, key, message));
}

void Problems::add_rest(const Problems& others,
                        const std::function<void(const std::string&, const std::string&)>& of_override) {
  for (const auto& line : others.lines_) {
    const auto& [overridden, row, column, text] = line;
    const auto end = text.find(": ");
    if (overridden)
      of_override(text.substr(override_mark.size(), end - override_mark.size()), text.substr(end + 2));
    else
      lines_.insert(line);
  }
}

void Problems::throw_if_any() const {
  if (lines_.empty()) return;
  std::string text;
  for (const auto& line : lines_) text += (text.empty() ? "" : "\n") + std::get<3>(line);
  throw InputError(text);
}

std::string printable(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string result;
  for (const char letter : text.substr(0, longest)) {
    result += static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f ? '?' : letter;
  }
  return result + (text.size() > longest ? "..." : "");
}

std::string shown(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", printable(text->get()));
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* array = node.as_array()) return fmt::format("an array of {}", array->size());
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::string toml_string(std::string_view text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20 || letter == '"' || letter == '\\' || letter == 0x7f) {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
    } else {
      result += letter;
    }
  }
  return result + '"';
}

std::string toml_value(const toml::node& node) {
  if (const auto* text = node.as_string()) return toml_string(text->get());
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) {
    // TOML tells 1.0 from 1.
    const std::string text = fmt::format("{}", number->get());
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  std::string text;
  if (const auto* array = node.as_array()) {
    for (const toml::node& element : *array) text += (text.empty() ? "" : ", ") + toml_value(element);
    return "[" + text + "]";
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [name, value] : *table)
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", toml_string(name.str()), toml_value(value));
    return "{" + text + "}";
  }
  return toml_string(shown(node));  // a date or time, which no key takes
}

void require_known_keys(const toml::table& table, std::string_view section,
                        const std::vector<std::string_view>& names, Problems& problems) {
  for (const auto& [name, node] : table) {
    if (std::ranges::find(names, name.str()) != names.end()) continue;
    const std::string help = hint(did_you_mean(name.str(), names));
    problems.add(name.source(),
                 fmt::format("unknown key \"{}\"{}{}", printable(name.str()),
                             section.empty() ? "" : fmt::format(" in [{}]", section),
                             help.empty() ? fmt::format("; keys: {}", fmt::join(names, ", ")) : help));
  }
}

namespace {

// The parser builds and takes down nested tables recursively, and dotted keys nest without a limit of
// its own. Dots of numbers apart, a scene has few.
void require_few_dots(std::string_view text, Problems& problems) {
  constexpr int most_dots = 2000;
  const auto is_digit = [&](std::size_t at) {
    return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
  };
  int dots = 0;
  bool number_has_dot = false;
  toml::source_index line = 1, column = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    ++column;
    if (text[i] == '\n') {
      ++line;
      column = 0;
    }
    if (text[i] != '.') {
      number_has_dot = number_has_dot && std::isalnum(static_cast<unsigned char>(text[i])) != 0;
      continue;
    }
    if (!number_has_dot && i > 0 && is_digit(i - 1) && is_digit(i + 1)) {
      number_has_dot = true;
    } else if (++dots > most_dots) {
      problems.add(
          {{line, column}, {line, column}, nullptr},
          fmt::format("more than {} dots outside of numbers: this is no scene and no sweep", most_dots));
      problems.throw_if_any();
    }
  }
}

}  // namespace

std::string toml_text(const std::filesystem::path& file, std::string_view kind) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(fmt::format("{}: there is no such file", file.string()));
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("{}: is a folder; name a {} file in it", file.string(), kind));
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read", file.string()));
  // Far beyond any of them; a wrong file is told before it is read whole.
  constexpr std::streamsize most_bytes = 1 << 20;
  std::string text(most_bytes + 1, '\0');
  stream.read(text.data(), most_bytes + 1);
  if (stream.bad()) throw InputError(fmt::format("{}: cannot be read", file.string()));
  if (stream.gcount() > most_bytes) {
    throw InputError(fmt::format("{}: is larger than 1 MiB and no {} file", file.string(), kind));
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

toml::table parse_toml(std::string_view text, const std::filesystem::path& file, Problems& problems) {
  require_few_dots(text, problems);
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    problems.add(error.source(), std::string(error.description()));
  }
  problems.throw_if_any();
  return {};
}

}  // namespace myowave::apps
