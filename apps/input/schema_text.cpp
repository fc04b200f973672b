// The table of keys in words: types, ranges and defaults, for a terminal and as Markdown.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "apps/input/did_you_mean.hpp"
#include "apps/input/schema.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

// Text wrapped at `width`, every line after the first indented.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::string result;
  std::size_t column = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (column > indent && column + word.size() + 1 > width) {
      result += '\n';
      result.append(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string header_text(const Section& section) {
  return section.repeated ? fmt::format("[[{}]]", section.name) : fmt::format("[{}]", section.name);
}

std::string inherited_text(const Section& section) {
  return fmt::format("Also every key of [{}] by its bare name; what is not named is as in the scene.",
                     fmt::join(section.inherits, "] and ["));
}

std::string describe_section(const Section& section) {
  std::string text = fmt::format("{}\n  {}\n", header_text(section), wrapped(section.doc, 2, 100));
  for (const Key& key : section.keys) {
    std::string facts = type_text(key.kind);
    if (const std::string range = range_text(key.kind); !range.empty()) facts += ", " + range;
    if (!key.unit.empty()) facts += fmt::format(", in {}", key.unit);
    const std::string value = default_text(key);
    facts += key.required ? ", required" : fmt::format(", default {}", value);
    if (!key.only_type.empty()) facts += fmt::format(", only with type = \"{}\"", key.only_type);
    text += fmt::format("  {:<19}{}\n{:21}{}\n", key.name, wrapped(facts, 21, 100), "",
                        wrapped(key.doc, 21, 100));
  }
  if (!section.inherits.empty()) text += fmt::format("  {}\n", inherited_text(section));
  for (const auto& [name, note] : section.notes)
    text += fmt::format("  {:<19}{}\n", name, wrapped(note, 21, 100));
  return text;
}

}  // namespace

std::string Range::text() const {
  if (!bounded()) return "finite";
  if (!std::isfinite(high)) return fmt::format("{} {}", low_open ? ">" : ">=", low);
  if (!std::isfinite(low)) return fmt::format("<= {}", high);
  return low_open ? fmt::format("> {} and <= {}", low, high) : fmt::format("{} to {}", low, high);
}

std::string type_text(const Kind& kind) {
  return std::visit(
      Overloaded{
          [](const Number&) -> std::string { return "number"; },
          [](const Integer&) -> std::string { return "integer"; },
          [](const Flag&) -> std::string { return "true or false"; },
          [](const Choice& one) { return fmt::format("\"{}\"", fmt::join(one.names, "\" or \"")); },
          [](const Choices& one) { return fmt::format("list of \"{}\"", fmt::join(one.names, "\", \"")); },
          [](const Path&) -> std::string { return "path"; },
          [](const Pair& one) { return fmt::format("{}, two integers", one.parts); },
          [](const Size&) -> std::string { return "integer or [rows, columns]"; },
          [](const Probes&) -> std::string { return "list of [row, column]"; },
          [](const Region&) -> std::string {
            return "\"all\", {center = [column, row], radius = R} or {columns = [a, b], rows = [a, b]}";
          },
      },
      kind);
}

std::string range_text(const Kind& kind) {
  const Range* range = nullptr;
  std::visit(
      [&](const auto& one) {
        if constexpr (requires { one.range; }) range = &one.range;
      },
      kind);
  if (range == nullptr) return "";
  // A bound that is only the width of an int says nothing to a reader.
  constexpr double largest_int = std::numeric_limits<int>::max();
  Range shown = *range;
  if (shown.high >= largest_int) shown.high = Range{}.high;
  if (shown.low <= -largest_int) shown.low = Range{}.low;
  return shown.bounded() ? shown.text() : "";
}

std::string default_text(const Key& key) {
  if (!key.default_text.empty()) return std::string(key.default_text);
  solver::Scene scene;
  scene.mechanics.emplace();
  solver::Stimulus stimulus;
  solver::Precondition precondition;
  Target target(scene);
  target.stimulus = &stimulus;
  target.precondition = &precondition;
  const nlohmann::json value = value_of(key, target);
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

std::string describe(std::string_view name) {
  if (name.empty()) {
    std::string text;
    for (const Section& section : schema()) {
      if (!text.empty()) text += '\n';
      text += describe_section(section);
    }
    return text;
  }
  if (const Section* section = find_section(name)) return describe_section(*section);
  std::vector<std::string_view> names;
  for (const Section& section : schema()) names.push_back(section.name);
  const std::string meant = did_you_mean(name, names);
  throw solver::InputError(fmt::format("there is no section [{}]{} Sections: {}", name,
                                       meant.empty() ? "." : fmt::format("; did you mean \"{}\"?", meant),
                                       fmt::join(names, ", ")));
}

std::string describe_markdown() {
  std::string text;
  for (const Section& section : schema()) {
    text += fmt::format("### `{}`\n\n{}\n\n", header_text(section), section.doc);
    text += "| key | type and range | unit | default | meaning |\n|---|---|---|---|---|\n";
    for (const Key& key : section.keys) {
      std::string type = type_text(key.kind);
      if (const std::string range = range_text(key.kind); !range.empty()) type += ", " + range;
      std::string doc(key.doc);
      if (!key.only_type.empty()) doc += fmt::format(" Only with `type = \"{}\"`.", key.only_type);
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, type, key.unit, default_text(key), doc);
    }
    if (!section.inherits.empty()) text += fmt::format("\n{}\n", inherited_text(section));
    if (!section.notes.empty()) text += '\n';
    for (const auto& [name, note] : section.notes) text += fmt::format("- `{}`: {}\n", name, note);
    text += '\n';
  }
  return text;
}

std::string requirement_text(const Key& key) {
  const std::string range = range_text(key.kind);
  std::string text;
  if (std::holds_alternative<Number>(key.kind)) {
    text = range.empty() ? "a finite number" : "a number " + range;
  } else if (std::holds_alternative<Integer>(key.kind)) {
    text = range.empty() ? "an integer" : "an integer " + range;
  } else if (std::holds_alternative<Path>(key.kind)) {
    text = "a path in quotes";
  } else if (std::holds_alternative<Size>(key.kind)) {
    text = fmt::format("an {}, each {}", type_text(key.kind), range);
  } else {
    text = type_text(key.kind) + (range.empty() ? "" : ", each " + range);
  }
  return key.unit.empty() ? text : fmt::format("{} ({})", text, key.unit);
}

}  // namespace myowave::apps
