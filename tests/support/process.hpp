// A command at work beside the test, which can be signalled. What it says goes into a file.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace myowave::test {

class Process {
 public:
  // Of the myowave executable, or of another program where `program` names one.
  Process(const std::vector<std::string>& arguments, std::filesystem::path errors,
          const std::string& program = MYOWAVE_EXECUTABLE)
      : errors_(std::move(errors)) {
    std::vector<std::string> line{program};
    line.insert(line.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (auto& one : line) argv.push_back(one.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, 2, errors_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    EXPECT_EQ(posix_spawnp(&id_, program.c_str(), &files, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&files);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (!status_) send(SIGKILL), wait();
  }

  pid_t id() const { return id_; }
  void send(int signal) const { kill(id_, signal); }

  // Exit status, or minus the signal that ended it.
  int wait() {
    if (status_) return *status_;
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    return ended(status);
  }

  // Empty where it has not ended by then.
  std::optional<int> wait_for(std::chrono::duration<double> time) {
    const auto end = std::chrono::steady_clock::now() + time;
    do {
      int status = 0;
      if (waitpid(id_, &status, WNOHANG) == id_) return ended(status);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (std::chrono::steady_clock::now() < end);
    return std::nullopt;
  }

  // That a file has come to so many bytes; false after half a minute, for the machine may be busy.
  static bool waits_until_there(const std::filesystem::path& path, std::uintmax_t bytes = 1) {
    for (int n = 0; n < 30000; ++n) {
      std::error_code missing;
      if (const auto size = std::filesystem::file_size(path, missing); !missing && size >= bytes) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

  std::string errors() const { return read_text(errors_); }

 private:
  int ended(int status) {
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return *status_;
  }

  pid_t id_ = 0;
  std::filesystem::path errors_;
  std::optional<int> status_;
};

}  // namespace myowave::test
