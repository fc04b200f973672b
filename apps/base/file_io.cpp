#include "apps/base/file_io.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace myowave::apps {
namespace {

[[noreturn]] void throw_errno(const std::filesystem::path& path, int error) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
}

void write_all(std::FILE* file, std::string_view content, const std::filesystem::path& path) {
  if (std::fwrite(content.data(), 1, content.size(), file) != content.size() || std::fflush(file) != 0) {
    throw_errno(path, errno);
  }
}

}  // namespace

void sync_file(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw_errno(path, errno);
  const int error = fsync(file) == 0 ? 0 : errno;
  close(file);
  if (error != 0) throw_errno(path, error);
}

void replace_file(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.tmp", getpid());
  try {
    { const AppendedFile written(temporary, content); }
    std::filesystem::rename(temporary, path);
  } catch (const std::filesystem::filesystem_error& error) {
    throw_errno(path, error.code().value());
  } catch (const std::runtime_error&) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

AppendedFile::AppendedFile(std::filesystem::path path, std::string_view header)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) throw_errno(path_, errno);
  write_all(file_.get(), header, path_);
}

AppendedFile::AppendedFile(std::filesystem::path path, std::uintmax_t size) : path_(std::move(path)) {
  std::error_code error;
  const auto there = std::filesystem::file_size(path_, error);
  if (error || there < size)
    throw std::runtime_error(
        fmt::format("cannot resume {}: {}", path_.string(),
                    error ? error.message() : fmt::format("{} of its {} bytes are there", there, size)));
  std::filesystem::resize_file(path_, size, error);
  if (error) throw_errno(path_, error.value());
  file_.reset(std::fopen(path_.c_str(), "r+b"));
  if (!file_ || std::fseek(file_.get(), 0, SEEK_END) != 0) throw_errno(path_, errno);
}

std::uintmax_t AppendedFile::sync() {
  const auto size = std::filesystem::file_size(path_);
  if (size != synced_) sync_file(path_);
  return *(synced_ = size);
}

void AppendedFile::append(std::string_view rows) { write_all(file_.get(), rows, path_); }

void AppendedFile::append_over_tail(std::string_view text, long tail) {
  if (std::fseek(file_.get(), -tail, SEEK_END) != 0) throw_errno(path_, errno);
  write_all(file_.get(), text, path_);
}

}  // namespace myowave::apps
