// Runs the real `myowave` executable.
#pragma once

#include <string>
#include <vector>

namespace myowave::test {

struct Outcome {
  int status = 0;  // exit status; -1 where a signal ended it
  std::string output, errors;
};

// Arguments are passed as they are, no shell expands them.
Outcome run_myowave(const std::vector<std::string>& arguments);

}  // namespace myowave::test
