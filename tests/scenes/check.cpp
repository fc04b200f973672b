// `myowave check` on a shipped scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave {
namespace {

TEST(Check, PrintsPlanMemoryAndTimeAndLeavesNoFiles) {
  const test::TemporaryFolder folder;
  setenv("TMPDIR", folder.path().c_str(), 1);
  const test::Outcome outcome = test::run_myowave(
      {"check", MYOWAVE_SOURCE_DIR "/apps/scenes/rigid_spiral.toml", "--set", "time.t_end=4"});
  unsetenv("TMPDIR");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  for (const char* line :
       {"excitation                32.0  Aliev-Panfilov", "active tension            16.0  delayed law",
        "mechanics                       not modelled: no [mechanics]: the sheet is rigid",
        "48 of state, 0 of coefficients", "time     about "})
    EXPECT_THAT(outcome.output, ::testing::HasSubstr(line));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace myowave
