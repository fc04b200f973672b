#include "tests/support/command.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace myowave::test {
namespace {

std::string quoted_for_shell(const std::string& text) {
  std::string result = "'";
  for (const char letter : text) {
    if (letter == '\'') {
      result += "'\\''";
    } else {
      result += letter;
    }
  }
  result += '\'';
  return result;
}

std::string taken_text(const std::filesystem::path& file) {
  std::string text;
  {
    std::ifstream stream(file, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(stream), {});
  }
  std::filesystem::remove(file);
  return text;
}

}  // namespace

Outcome run_myowave(const std::vector<std::string>& arguments) {
  static int number = 0;
  const std::string files =
      ::testing::TempDir() + "myowave_" + std::to_string(getpid()) + "_" + std::to_string(++number);
  std::string line = quoted_for_shell(MYOWAVE_EXECUTABLE);
  for (const std::string& one : arguments) line.append(" ").append(quoted_for_shell(one));
  line += " >" + quoted_for_shell(files + ".out") + " 2>" + quoted_for_shell(files + ".err") + " </dev/null";
  const int status = std::system(line.c_str());
  Outcome outcome;
  // A shell reports a signal as 128 + its number.
  outcome.status = WIFEXITED(status) && WEXITSTATUS(status) < 128 ? WEXITSTATUS(status) : -1;
  outcome.output = taken_text(files + ".out");
  outcome.errors = taken_text(files + ".err");
  return outcome;
}

}  // namespace myowave::test
