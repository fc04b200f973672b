// The fuzzer's bytes as a file, for readers that take a folder.
#pragma once

#include <stdlib.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>

namespace myowave::test {

// A folder for this process only; the system removes it.
inline std::filesystem::path folder_in_memory() {
  const bool there = std::filesystem::is_directory("/dev/shm");
  std::string name = std::string(there ? "/dev/shm" : "/tmp") + "/myowave_fuzz_XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  return name;
}

inline void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace myowave::test
