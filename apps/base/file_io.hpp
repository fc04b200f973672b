// Writes files; an error names the file and the reason.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace myowave::apps {

// Writes beside the file and renames, so that a reader finds the old content or the new one.
// Errors: std::runtime_error "cannot write FILE: reason".
void replace_file(const std::filesystem::path&, std::string_view content);

// Flushes a file to the disk.
// Errors: std::runtime_error "cannot write FILE: reason".
void sync_file(const std::filesystem::path&);

// A text file that grows. Each append goes to the system at once, so that a process that dies leaves
// whole rows.
class AppendedFile {
 public:
  // Errors: std::runtime_error "cannot write FILE: reason", here and in append.
  AppendedFile(std::filesystem::path, std::string_view header);
  // Resumes an existing file, cut to this size.
  // Errors: std::runtime_error that names the file where it is not there or smaller.
  AppendedFile(std::filesystem::path, std::uintmax_t size);
  void append(std::string_view rows);
  // The same, over the last `tail` bytes of what was written.
  void append_over_tail(std::string_view text, long tail);
  // Bytes. All of them are on the disk when this returns.
  std::uintmax_t sync();
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::optional<std::uintmax_t> synced_;  // size at the last sync()
};

}  // namespace myowave::apps
