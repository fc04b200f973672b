// Random valid scenes through the executable: exit status, files and their content.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "apps/input/scene_file.hpp"
#include "apps/input/schema.hpp"
#include "tests/support/command.hpp"
#include "tests/support/random_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// Every file of the scene's outputs exists, and tables contain only numbers.
void expect_files(const solver::Scene& scene, const std::filesystem::path& out) {
  for (const char* name : {"tips.csv", "trajectories.csv", "sources.csv", "probes.csv", "area.csv"})
    EXPECT_THAT(read_text(out / name), Not(ContainsRegex("nan|inf|NaN"))) << name;
  EXPECT_EQ(std::filesystem::exists(out / "fields.h5"), scene.output.fields);
  EXPECT_EQ(std::filesystem::exists(out / "frames/frame_00000.png"), scene.output.frames);
  const auto manifest = nlohmann::json::parse(read_text(out / "manifest.json"));
  EXPECT_THAT(manifest.dump(), HasSubstr(apps::effective_configuration(scene).dump()));
}

// Of time.stop_on.
bool ended_early(const solver::Scene& scene, const nlohmann::json& summary) {
  const auto& [breakup, death] = scene.time.stop_on;
  const auto& seen = summary.at("observables");
  return (death && !seen.at("death_tu").is_null()) || (breakup && !seen.at("breakup_tu").is_null());
}

TEST(RandomScenes, LeaveTheirFilesAndAStatus) {
  std::map<int, int> statuses;
  const auto [first, last] = seeds(24);
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const std::string text = random_scene(seed).text();
    SCOPED_TRACE(fmt::format("MYOWAVE_SEEDS={}, this scene:\n{}", seed, text));
    const TemporaryFolder folder;
    const std::string file = (folder / "random.toml").string();
    std::ofstream(file) << text;
    const Outcome outcome = run_myowave({"run", file, "--out", (folder / "out").string(), "--quiet"});
    ++statuses[outcome.status];
    ASSERT_THAT(outcome.status, ::testing::AnyOf(0, 3)) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    const auto summary = nlohmann::json::parse(read_text(folder / "out/summary.json"));
    const solver::Scene scene = apps::parse_scene(text, file);
    if (outcome.status == 3) {
      EXPECT_THAT(outcome.errors, HasSubstr(summary.at("failure").get<std::string>()));
      continue;
    }
    std::string warnings;
    for (const auto& warning : summary.at("warnings"))
      warnings += "myowave: warning: " + warning.get<std::string>() + "\n";
    EXPECT_EQ(outcome.errors, warnings);
    EXPECT_TRUE(summary.at("failure").is_null());
    const auto steps = std::llround(scene.time.t_end / scene.time.dt);
    EXPECT_TRUE(summary.at("steps") == steps || ended_early(scene, summary));
    expect_files(scene, folder / "out");
  }
  fmt::print("{} runs ended with status 0, {} with 3\n", statuses[0], statuses[3]);
}

TEST(RandomScenes, DrawEveryKeyOfTheSchema) {
  std::set<std::string> drawn;
  for (std::uint64_t seed = 1; seed <= 500; ++seed)
    for (const auto& table : random_scene(seed).tables)
      for (const auto& line : table.lines) drawn.insert(table.section + "." + line.key);
  // A state that takes minutes, or comes from a file.
  const std::set<std::string> left_out{"initial.core_offset", "initial.file", "initial.window"};
  for (const apps::Section& section : apps::schema())
    for (const apps::Key& key : section.keys) {
      const std::string path = fmt::format("{}.{}", section.name, key.name);
      EXPECT_NE(drawn.contains(path), left_out.contains(path)) << path;
    }
}

}  // namespace
}  // namespace myowave::test
