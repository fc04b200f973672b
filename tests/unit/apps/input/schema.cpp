// The schema table against everything generated from it: every key is read, checked, described and shown.
#include "apps/input/schema.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/input/scene_file.hpp"
#include "solver/base/error.hpp"
#include "tests/support/command.hpp"

namespace {

using namespace myowave;
using apps::Key;
using apps::Section;
using ::testing::HasSubstr;

// A scene in which every key of every section has an effect; core_offset, file and window belong to
// other types of initial state.
constexpr std::string_view full_scene = R"(
[mechanics]
[initial]
type = "broken_front"
[[initial.precondition]]
duration = 3
[[stimulus]]
amplitude = 1
)";

nlohmann::json configuration(const std::vector<std::string>& overrides, std::string_view text = full_scene) {
  return apps::effective_configuration(apps::parse_scene(text, "full.toml", overrides));
}

std::string path_of(const Section& section, const Key& key) {
  return fmt::format("{}{}.{}", section.name, section.repeated ? ".0" : "", key.name);
}

// A value that the key takes and that is not its default.
std::string other_value(const Key& key) {
  if (key.name == "n") return "[21,31]";
  if (key.name == "cells_per_element") return "5";
  if (key.name == "count") return "0";
  if (key.name == "duration") return "2.5";
  if (key.name == "period") return "33.5";
  if (key.name.ends_with("every") && key.name != "checkpoint_every") return "0.5";
  if (key.name == "dt") return "0.01";
  if (key.name == "dx") return "1.2";
  if (key.name == "tolerance") return "1e-6";
  if (std::holds_alternative<apps::Number>(key.kind)) return key.name == "a" ? "0.25" : "1.25";
  if (std::holds_alternative<apps::Integer>(key.kind)) return "7";
  if (std::holds_alternative<apps::Pair>(key.kind)) return "[2,-3]";
  if (std::holds_alternative<apps::Choices>(key.kind)) return "[\"death\"]";
  if (std::holds_alternative<apps::Probes>(key.kind)) return "[[1,2],[3,4]]";
  if (std::holds_alternative<apps::Region>(key.kind)) return "{center=[10,11],radius=2.5}";
  return "";
}

TEST(schema, names_are_unique_and_documented) {
  std::set<std::string> sections;
  for (const Section& section : apps::schema()) {
    EXPECT_TRUE(sections.insert(std::string(section.name)).second) << section.name;
    EXPECT_FALSE(section.doc.empty()) << section.name;
    std::set<std::string> keys;
    for (const Key& key : section.keys) {
      EXPECT_TRUE(keys.insert(std::string(key.name)).second) << section.name << "." << key.name;
      EXPECT_FALSE(key.doc.empty()) << section.name << "." << key.name;
      EXPECT_FALSE(apps::default_text(key).empty()) << section.name << "." << key.name;
    }
  }
}

TEST(schema, an_empty_file_is_a_default_scene) {
  const solver::Scene scene = apps::parse_scene("", "nothing.toml");
  solver::Scene defaults;
  EXPECT_EQ(scene.name, "nothing");
  EXPECT_FALSE(scene.mechanics.has_value());
  // model.md's default probes: (q, q), (q, m-q), (m-q, q), (m-q, m-q) with m = 250, q = 62.
  defaults.output.probes = {{62, 62}, {62, 188}, {188, 62}, {188, 188}};
  defaults.output.tension = false;  // nothing asks for Ta
  EXPECT_EQ(apps::effective_configuration(scene), apps::effective_configuration(defaults));
}

TEST(schema, each_key_changes_what_it_names) {
  const nlohmann::json before = configuration({});
  for (const Section& section : apps::schema()) {
    for (const Key& key : section.keys) {
      const std::string value = other_value(key);
      if (value.empty() || key.name == "eps0" || key.only_type == "file" || key.only_type == "settled_spiral")
        continue;
      const std::string path = path_of(section, key);
      SCOPED_TRACE(path);
      const nlohmann::json after = configuration({fmt::format("{}={}", path, value)});
      const nlohmann::json changes = nlohmann::json::diff(before, after);
      std::string pointer = "/" + path;
      std::replace(pointer.begin(), pointer.end(), '.', '/');
      const bool found = std::any_of(changes.begin(), changes.end(), [&](const nlohmann::json& change) {
        return change["path"].get<std::string>().starts_with(pointer);
      });
      EXPECT_TRUE(found) << value << " changed " << changes;
    }
  }
}

TEST(schema, each_range_is_kept) {
  for (const Section& section : apps::schema()) {
    for (const Key& key : section.keys) {
      const apps::Range* range = nullptr;
      if (const auto* number = std::get_if<apps::Number>(&key.kind)) range = &number->range;
      if (const auto* integer = std::get_if<apps::Integer>(&key.kind)) range = &integer->range;
      if (range == nullptr) continue;
      const std::string path = path_of(section, key);
      std::vector<std::string> bad{"nan", "inf", "-inf", "true", "abc", "[1]", "{a=1}", "1979-05-27"};
      if (std::isfinite(range->low)) bad.push_back(fmt::format("{}", range->low - 1));
      if (std::isfinite(range->high)) bad.push_back(fmt::format("{:.0f}", range->high + 1));
      if (range->low_open) bad.push_back(fmt::format("{}", range->low));
      for (const std::string& value : bad) {
        SCOPED_TRACE(path + "=" + value);
        try {
          configuration({path + "=" + value});
          ADD_FAILURE() << "was accepted";
        } catch (const solver::InputError& error) {
          EXPECT_THAT(error.what(), HasSubstr(fmt::format("--set {}: {} must be", path, path)));
          EXPECT_THAT(error.what(), HasSubstr(apps::range_text(key.kind)));
        }
      }
    }
  }
}

TEST(schema, choices_set_what_they_name) {
  for (const Section& section : apps::schema()) {
    for (const Key& key : section.keys) {
      const auto* choice = std::get_if<apps::Choice>(&key.kind);
      if (choice == nullptr || key.name == "type") continue;
      for (std::string_view name : choice->names) {
        // without contraction any law will do
        const nlohmann::json after = configuration(
            {fmt::format("{}.{}={}", section.name, key.name, name), "mechanics.contraction=false"});
        EXPECT_EQ(after[std::string(section.name)][std::string(key.name)], name);
      }
    }
  }
  // The enumerators and the names stand in the same order.
  using solver::MetricForm;
  EXPECT_EQ(apps::parse_scene(R"(feedback.metric = "expanded")", "a").metric, MetricForm::expanded);
  EXPECT_EQ(apps::parse_scene(R"(feedback.metric = "none")", "a").metric, MetricForm::none);
  EXPECT_EQ(apps::parse_scene(R"(mechanics.load = "dead")", "a").mechanics->load, solver::Load::dead);
  EXPECT_EQ(apps::parse_scene(R"(mechanics.edges = "fixed")", "a").mechanics->edges, solver::Edges::fixed);
  EXPECT_EQ(apps::parse_scene(R"(accuracy.precision = "float32")", "a").precision,
            solver::Precision::float32);
  EXPECT_EQ(apps::parse_scene(R"(initial.type = "settled_spiral")", "a").initial.type,
            solver::InitialSettings::Type::settled_spiral);
}

TEST(schema, describe_names_every_key) {
  const std::string all = apps::describe("");
  for (const Section& section : apps::schema()) {
    EXPECT_THAT(all, HasSubstr(apps::describe(section.name)));
    for (const Key& key : section.keys) {
      EXPECT_THAT(apps::describe(section.name), HasSubstr(fmt::format("\n  {} ", key.name)));
    }
  }
  EXPECT_THAT([] { apps::describe("mechanic"); },
              ::testing::ThrowsMessage<solver::InputError>(HasSubstr("did you mean \"mechanics\"?")));
}

TEST(schema, the_reference_is_what_describe_prints) {
  std::ifstream file(MYOWAVE_SOURCE_DIR "/apps/input/REFERENCE.md");
  const std::string reference(std::istreambuf_iterator<char>(file), {});
  const std::string begin = "<!-- scene reference: begin, from `myowave describe --markdown` -->\n";
  const std::string end = "<!-- scene reference: end -->";
  const std::size_t from = reference.find(begin), to = reference.find(end);
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  EXPECT_EQ(reference.substr(from + begin.size(), to - from - begin.size()), apps::describe_markdown())
      << "put the output of `myowave describe --markdown` between the markers of apps/input/REFERENCE.md";
  const test::Outcome outcome = test::run_myowave({"describe", "--markdown"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output, apps::describe_markdown());
}

}  // namespace
