// The TOML blocks of the documentation are valid scenes and sweeps.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "apps/input/scene_file.hpp"
#include "apps/sweep/sweep_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

// The texts between ```toml and ``` of a file, by its path from the root.
std::vector<std::string> examples_of(const std::string& file) {
  std::istringstream markdown(test::read_text(MYOWAVE_SOURCE_DIR "/" + file));
  std::vector<std::string> examples;
  bool within = false;
  for (std::string line; std::getline(markdown, line);) {
    if (line == "```toml") examples.emplace_back();
    if (within && !line.starts_with("```")) examples.back() += line + '\n';
    if (line.starts_with("```")) within = line == "```toml";
  }
  return examples;
}

TEST(DocumentationExamples, ScenesAreValid) {
  for (const char* file : {"apps/README.md", "apps/input/README.md"}) {
    const auto examples = examples_of(file);
    EXPECT_EQ(examples.size(), 1U) << file;
    for (const auto& text : examples) {
      SCOPED_TRACE(file);
      const solver::Scene scene = parse_scene(text, "example.toml");
      EXPECT_TRUE(scene.mechanics.has_value());
      EXPECT_EQ(scene.grid.rows, 121);
    }
  }
}

TEST(DocumentationExamples, SweepsHaveTheRunsThatAreNamed) {
  const auto examples = examples_of("apps/sweep/README.md");
  ASSERT_EQ(examples.size(), 2U);
  const auto file = MYOWAVE_SOURCE_DIR "/apps/scenes/example.toml";  // the scene's path is relative to it
  EXPECT_EQ(parse_sweep(examples[0], file).runs.size(), 3U * 2U);
  const auto all = parse_sweep(examples[1], file);
  EXPECT_EQ(all.runs.size(), 10U * 2U * 8U * 2U);
  EXPECT_TRUE(all.pairs.has_value());
}

}  // namespace
}  // namespace myowave::apps
