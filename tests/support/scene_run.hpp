// Runs a shipped scene through the executable and reads what it leaves.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::test {

// A CSV file by columns.
using Table = std::map<std::string, std::vector<double>>;

inline Table read_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line, cell;
  std::vector<std::string> names;
  std::getline(file, line);
  for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
  Table table;
  for (const auto& name : names) table[name] = {};
  while (std::getline(file, line)) {
    std::istringstream row(line);
    for (const auto& name : names) {
      std::getline(row, cell, ',');
      table[name].push_back(std::strtod(cell.c_str(), nullptr));
    }
  }
  return table;
}

class SceneRun {
 public:
  // Without pictures and fields, which other tests look at; further arguments follow the scene's.
  explicit SceneRun(const std::string& scene, const std::vector<std::string>& further = {}) {
    // One cache for all test runs: the settled spiral takes longest.
    setenv("XDG_CACHE_HOME", MYOWAVE_TEST_CACHE, 1);
    std::vector<std::string> arguments{"run",   MYOWAVE_SOURCE_DIR "/apps/scenes/" + scene + ".toml",
                                       "--out", (folder_ / "out").string(),
                                       "--set", "output.frames=false",
                                       "--set", "output.fields=false"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    const Outcome outcome = run_myowave(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    output = outcome.output;
    if (outcome.status == 0) summary = nlohmann::json::parse(read_text(folder_ / "out/summary.json"));
  }

  const nlohmann::json& observable(const char* name) const { return summary.at("observables").at(name); }
  double number(const char* name, const char* part) const { return observable(name).at(part).get<double>(); }
  Table csv(const std::string& file) const { return read_csv(folder_ / ("out/" + file)); }

  nlohmann::json summary;
  std::string output;  // what it printed

 private:
  TemporaryFolder folder_;
};

}  // namespace myowave::test
