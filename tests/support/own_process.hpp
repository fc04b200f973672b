// A test that needs another environment than its own, such as the number of threads, starts its
// executable again with only itself to run, and the second process writes what the first one reads.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace myowave::test {

inline constexpr const char* report_variable = "MYOWAVE_TEST_REPORT";

// Where the second process writes its report; empty in the first one.
inline std::string report_path() {
  const char* path = std::getenv(report_variable);
  return path ? path : "";
}

// Runs the current test again with assignments such as "OMP_NUM_THREADS=2" in its environment.
// What the second process wrote; a failure of the test where it failed.
inline std::string report_of_own_process(const std::string& assignments) {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = std::string(info->test_suite_name()) + "." + info->name();
  const auto executable = std::filesystem::read_symlink("/proc/self/exe");
  const auto path = std::filesystem::temp_directory_path() /
                    ("myowave_" + name + "_" + std::to_string(::getpid()) + ".txt");
  // More threads than cores: waiting ones must yield, and Kokkos need not warn.
  const std::string command = "env OMP_PROC_BIND=false OMP_WAIT_POLICY=passive KOKKOS_DISABLE_WARNINGS=1 " +
                              assignments + " " + report_variable + "='" + path.string() + "' '" +
                              executable.string() + "' --gtest_filter='" + name + "' --gtest_brief=1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::ostringstream report;
  report << std::ifstream(path).rdbuf();
  std::filesystem::remove(path);
  return report.str();
}

}  // namespace myowave::test
