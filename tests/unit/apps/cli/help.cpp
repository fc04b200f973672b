// `myowave help` shows every section that a user of the command reads.
#include "apps/cli/help.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "apps/base/embedded_files.hpp"
#include "solver/base/error.hpp"
#include "tests/support/command.hpp"

namespace myowave::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Help, EachTopicHasItsText) {
  std::set<std::string> texts;
  for (const HelpTopic& topic : help_topics()) {
    const std::string text = help_text(topic.name);
    EXPECT_THAT(text, StartsWith("#")) << topic.name;
    EXPECT_GT(text.size(), 400U) << topic.name;
    EXPECT_TRUE(texts.insert(text).second) << topic.name << " is another's";
  }
}

// What a user of the command reads is no farther away than `myowave help`.
TEST(Help, EachSectionForUsersIsInATopic) {
  std::string shown;
  for (const HelpTopic& topic : help_topics()) shown += '\n' + help_text(topic.name);
  for (const char* room : {"", "cli/", "input/", "results/", "sweep/", "report/", "tradeoff/", "stability/",
                           "paper/", "scenes/"}) {
    const std::string readme(embedded_file(fmt::format("apps/{}README.md", room)));
    ASSERT_THAT(readme, StartsWith("# ")) << room;
    for (std::size_t at = readme.find("\n## "); at != std::string::npos; at = readme.find("\n## ", at + 1)) {
      const std::string heading = readme.substr(at, readme.find('\n', at + 1) + 1 - at);
      if (heading == "\n## Files\n" || heading == "\n## Rooms\n") continue;  // of source files
      EXPECT_THAT(shown, HasSubstr(heading)) << room;
    }
    EXPECT_GT(readme.size(), 1000U) << room;
  }
}

TEST(Help, MarkdownIsEmbeddedByItsPath) {
  EXPECT_THAT(embedded_file("README.md"), StartsWith("# myowave"));
  EXPECT_THAT(embedded_file("solver/README.md"), StartsWith("# solver"));
  EXPECT_THAT(embedded_file("kernels/README.md"), StartsWith("# kernels"));
  EXPECT_NE(embedded_file("apps/base/README.md"), embedded_file("kernels/base/README.md"));
  EXPECT_FALSE(embedded_file("quickstart.toml").empty());
  EXPECT_TRUE(embedded_file("apps.md").empty());
}

TEST(Help, ASectionEndsAtTheNextOfItsLevel) {
  const std::string text =
      "# Top\nfirst\n## One\nsee [there](a.md#b), ![p](p.png)\n### Inner\n```toml\n# a comment\n```\n## "
      "Two\nlast\n";
  EXPECT_EQ(section_of(text, "One"), "## One\nsee there, !p\n### Inner\n```toml\n# a comment\n```\n");
  EXPECT_EQ(section_of(text, "Inner"), "### Inner\n```toml\n# a comment\n```\n");
  EXPECT_EQ(section_of(text, "Two"), "## Two\nlast\n");
  EXPECT_EQ(section_of(text, "Three"), "");
}

TEST(Help, AWholeFileIsShownWithoutItsSectionsOnSourceFiles) {
  const std::string text =
      "# Top\n<!-- note -->\n![p](p.png)\n## One\nsee [there](a.md#b)\n## Files\nschema\n### Inner\nmore\n"
      "## Two\nlast\n### Files\nnone\n";
  EXPECT_EQ(section_of(text, ""), "# Top\n## One\nsee there\n## Two\nlast\n");
  EXPECT_EQ(section_of(text, "Two"), "## Two\nlast\n");
  EXPECT_EQ(section_of(text, "Files"), "## Files\nschema\n### Inner\nmore\n");
}

TEST(Help, AnUnknownTopicNamesTheNearestAndAll) {
  try {
    help_text("swepes");
    FAIL() << "found";
  } catch (const solver::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no help on \"swepes\"; did you mean \"sweeps\"?"));
    EXPECT_THAT(error.what(), HasSubstr("checkpoints"));
  }
}

TEST(Help, TheCommandShowsTopicsAndOptions) {
  const auto all = test::run_myowave({"help"});
  EXPECT_EQ(all.status, 0);
  EXPECT_THAT(all.output, HasSubstr("tutorial"));
  EXPECT_THAT(all.output, HasSubstr("Run a scene and write its results"));  // all commands
  const auto topic = all.output.find("  checkpoints ");
  EXPECT_NE(topic, std::string::npos);
  EXPECT_EQ(all.output.find("  checkpoints ", topic + 1), std::string::npos) << "twice";
  const auto sweeps = test::run_myowave({"help", "sweeps"});
  EXPECT_THAT(sweeps.output, StartsWith("# sweep"));
  EXPECT_THAT(sweeps.output, HasSubstr("## Several machines"));
  EXPECT_THAT(sweeps.output, Not(HasSubstr("# Faults")));
  EXPECT_THAT(test::run_myowave({"help", "model"}).output, StartsWith("# The model"));
  EXPECT_THAT(test::run_myowave({"help", "run"}).output, HasSubstr("--resume"));
  // A command that is a topic too shows its options and the topic.
  EXPECT_THAT(test::run_myowave({"help", "report"}).output,
              AllOf(HasSubstr("--movie"), HasSubstr("# report")));
  const auto unknown = test::run_myowave({"help", "swepes"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("did you mean \"sweeps\"?"));
}

}  // namespace
}  // namespace myowave::apps
