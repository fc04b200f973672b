#include "apps/cli/help.hpp"

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
TEST(Help, EachSectionOfTheCommandsReadmeIsATopicOrTheReference) {
  const std::string readme(embedded_file("apps.md"));
  ASSERT_GT(readme.size(), 10000U);
  for (std::size_t at = readme.find("\n## "); at != std::string::npos; at = readme.find("\n## ", at + 1)) {
    const std::string heading = readme.substr(at + 4, readme.find('\n', at + 4) - at - 4);
    if (heading == "Files here" || heading == "Scene reference") continue;  // the latter is `describe`
    EXPECT_NE(std::ranges::find(help_topics(), heading, &HelpTopic::heading), help_topics().end()) << heading;
  }
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
  EXPECT_THAT(all.output, HasSubstr("tradeoff"));
  const auto sweeps = test::run_myowave({"help", "sweeps"});
  EXPECT_THAT(sweeps.output, StartsWith("## Sweeps"));
  EXPECT_THAT(sweeps.output, HasSubstr("### Several machines"));
  EXPECT_THAT(sweeps.output, Not(HasSubstr("## Faults")));
  EXPECT_THAT(test::run_myowave({"help", "run"}).output, HasSubstr("--resume"));
  const auto unknown = test::run_myowave({"help", "swepes"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("did you mean \"sweeps\"?"));
}

}  // namespace
}  // namespace myowave::apps
