// The tutorial as a reader follows it: each command of its blocks `sh`, in order; the blocks `text` are their
// output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace myowave::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// The lines between ```kind and ```.
std::vector<std::string> blocks(const std::string& markdown, const std::string& kind) {
  std::vector<std::string> inside;
  bool within = false;
  for (const auto& line : lines_of(markdown)) {
    if (line.starts_with("```"))
      within = line == "```" + kind;
    else if (within)
      inside.push_back(line);
  }
  return inside;
}

TEST(Tutorial, CommandsHaveTheDocumentedOutput) {
  const std::string tutorial = read_text(MYOWAVE_SOURCE_DIR "/apps/cli/tutorial.md");
  const TemporaryFolder temporary;
  const fs::path folder = temporary / "spirals";
  fs::create_directory(folder);
  fs::create_directory_symlink(MYOWAVE_SOURCE_DIR "/apps", folder / "apps");
  {
    std::ofstream script(temporary / "commands.sh");
    script << "set -e\ncd " << folder << "\nexport PATH=" << fs::path(MYOWAVE_EXECUTABLE).parent_path()
           << ":$PATH XDG_CACHE_HOME=" << fs::path(MYOWAVE_TEST_CACHE) << "\n";
    for (const auto& line : blocks(tutorial, "sh")) script << line << "\n";
  }
  const fs::path said = temporary / "said.txt";
  const int status =
      std::system(("bash " + (temporary / "commands.sh").string() + " >" + said.string() + " 2>&1").c_str());
  const std::string output = read_text(said);
  ASSERT_EQ(WEXITSTATUS(status), 0) << output;

  const auto lines = lines_of(output);
  for (const auto& expected : blocks(tutorial, "text"))
    EXPECT_THAT(lines, ::testing::Contains(::testing::StartsWith(expected))) << output;
  for (const char* file :
       {"out/first/frames/frame_00000.png", "out/first/fields.h5", "out/first/report.html",
        "out/compare.html", "out/spiral/summary.json", "out/fast/summary.json", "out/breakup/report.html"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
}

}  // namespace
}  // namespace myowave::test
