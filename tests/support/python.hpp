// Checks by programs that users open the results with.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace myowave::test {

// Runs a script with the system's Python, in `folder`. Returns its exit status: 0 good.
inline int run_python(const std::filesystem::path& folder, const std::string& script) {
  const auto file = folder / "check.py";
  std::ofstream(file) << script;
  const int status = std::system(("cd '" + folder.string() + "' && /usr/bin/python3 check.py").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

inline bool python_has(const std::filesystem::path& folder, const std::string& module) {
  return run_python(folder,
                    "import sys\ntry:\n  import " + module + "\nexcept ImportError:\n  sys.exit(1)\n") == 0;
}

}  // namespace myowave::test
