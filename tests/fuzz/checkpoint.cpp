// Checkpoints: any bytes are a checkpoint or are refused with one line, even with right checksums; and any
// bytes are a state or a StateMismatch.
#include "solver/run/checkpoint.hpp"

#include <xxhash.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/fuzz/file_of_bytes.hpp"

namespace {

using namespace myowave;

constexpr std::size_t header_size = 80, header_checksum = 72;  // bytes, solver/run/checkpoint.cpp

void put_checksum(std::vector<std::byte>& bytes, std::size_t begin, std::size_t end) {
  const std::uint64_t sum = XXH3_64bits(bytes.data() + begin, end - begin);
  std::memcpy(bytes.data() + end, &sum, sizeof sum);
}

// Without right checksums the fuzzer never gets past them.
std::vector<std::byte> with_checksums(std::vector<std::byte> bytes) {
  if (bytes.size() < header_size + sizeof(std::uint64_t)) return bytes;
  put_checksum(bytes, 0, header_checksum);
  put_checksum(bytes, header_size, bytes.size() - sizeof(std::uint64_t));
  return bytes;
}

void find(const std::filesystem::path& folder, std::span<const std::byte> bytes) {
  test::write_file(folder / "checkpoint_even", bytes);
  std::vector<std::string> refused;
  const auto found = solver::find_checkpoint(folder, refused);
  if (found.has_value() == !refused.empty()) __builtin_trap();
  if (found && found->state().size() > bytes.size()) __builtin_trap();
}

void read_state(std::span<const std::byte> bytes) {
  solver::StateReader reader(bytes);
  std::int64_t number = 0;
  std::string text;
  std::vector<double> values;
  std::vector<std::string> texts;
  std::array<float, 3> fixed{};
  const Kokkos::View<double*, Kokkos::HostSpace> view("view", 4);
  try {
    while (!reader.at_end()) reader(number, text, values, texts, fixed, view);
  } catch (const solver::StateMismatch&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Kokkos::ScopeGuard kokkos;
  static const auto folder = test::folder_in_memory();
  const auto bytes = std::as_bytes(std::span(data, size));
  find(folder, bytes);
  find(folder, with_checksums({bytes.begin(), bytes.end()}));
  read_state(bytes);
  return 0;
}
