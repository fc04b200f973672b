// Records of a sweep: any line is a record or is refused with one line, even with a right checksum.
#include <cstddef>
#include <cstdint>

#include "apps/sweep/sweep_records.hpp"
#include "tests/fuzz/file_of_bytes.hpp"

namespace {

void read(const std::filesystem::path& folder, std::span<const std::byte> bytes) {
  myowave::test::write_file(folder / "records" / "shard_1_of_1.jsonl", bytes);
  for (const auto& [id, record] : myowave::apps::read_records(folder).by_id)
    if (id.empty() || !record.is_object()) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto folder = myowave::test::folder_in_memory();
  std::filesystem::create_directory(folder / "records");
  read(folder, std::as_bytes(std::span(data, size)));
  // A record's text with a right checksum.
  const auto record = nlohmann::ordered_json::parse(data, data + size, nullptr, /* allow_exceptions */ false);
  if (!record.is_object() || record.empty()) return 0;
  const std::string line = myowave::apps::record_line(record);
  read(folder, std::as_bytes(std::span(line)));
  return 0;
}
