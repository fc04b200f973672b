#include "solver/run/checkpoint.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>
#include <utility>
#include <variant>

namespace myowave::solver {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t format_version = 3;
constexpr std::array<char, 16> magic{'m', 'y', 'o', 'w', 'a', 'v',  'e',  ' ',
                                     's', 't', 'a', 't', 'e', '\r', '\n', 0x1a};

struct Header {
  std::array<char, 16> magic = solver::magic;
  std::uint32_t version = format_version;
  std::uint32_t byte_order = 0x01020304;
  std::uint64_t serial = 0;
  std::int64_t step = 0;
  double t = 0;
  std::uint64_t identity_size = 0, mark_size = 0, state_size = 0;
  std::uint64_t checksum = 0;  // of all members above
};
static_assert(sizeof(Header) == 80 && offsetof(Header, checksum) == 72, "has no gaps");

std::uint64_t checksum_of(const Header& header) { return XXH3_64bits(&header, offsetof(Header, checksum)); }

// The two names alternate.
fs::path file_of(const fs::path& folder, std::uint64_t serial) {
  return folder / (serial % 2 == 0 ? "checkpoint_even" : "checkpoint_odd");
}

fs::path temporary_of(const fs::path& file) { return file.string() + ".tmp"; }

[[noreturn]] void refuse_write(const fs::path& path, int error) {
  throw std::runtime_error(
      fmt::format("cannot write {}: {}", path.string(), std::generic_category().message(error)));
}

// Writes a file that has its name only once it is complete and on the disk.
class NewFile {
 public:
  explicit NewFile(fs::path path) : path_(std::move(path)), temporary_(temporary_of(path_)) {
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) refuse_write(temporary_, errno);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    unlink(temporary_.c_str());
  }

  void write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const auto written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) refuse_write(temporary_, errno);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  void put_in_place() {
    if (fsync(descriptor_) != 0) refuse_write(temporary_, errno);
    if (close(std::exchange(descriptor_, -1)) != 0 || rename(temporary_.c_str(), path_.c_str()) != 0) {
      const int error = errno;
      unlink(temporary_.c_str());
      refuse_write(path_, error);
    }
    sync_folder();
  }

 private:
  // Otherwise a power failure can lose the name.
  void sync_folder() const {
    const int folder = open(path_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) refuse_write(path_, errno);
    const int error = fsync(folder) == 0 ? 0 : errno;
    close(folder);
    if (error != 0 && error != EINVAL)
      refuse_write(path_, error);  // EINVAL: the file system does not support it
  }

  fs::path path_, temporary_;
  int descriptor_ = -1;
};

std::span<const std::byte> bytes_of(const auto& object) { return std::as_bytes(std::span(&object, 1)); }
std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

std::vector<std::byte> content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0) throw std::runtime_error(fmt::format("cannot read {}", path.string()));
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  if (size > 0 && !file.read(reinterpret_cast<char*>(bytes.data()), size))
    throw std::runtime_error(fmt::format("cannot read {}", path.string()));
  return bytes;
}

// Returns the content of the file, or what is wrong with it.
std::variant<std::string, FoundCheckpoint> read_checkpoint(const fs::path& path) {
  if (!fs::is_regular_file(path)) return std::string("it is not a file");
  std::vector<std::byte> bytes = content(path);
  Header header;
  if (bytes.size() < sizeof header || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
    return bytes.size() < sizeof header && !bytes.empty() &&
                   std::memcmp(bytes.data(), magic.data(), std::min(bytes.size(), magic.size())) == 0
               ? fmt::format("it is truncated after {} bytes", bytes.size())
               : std::string("it is not a checkpoint of myowave");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.version > format_version)
    return fmt::format(
        "its format, {}, is newer than this program's, {}: resume with the program that wrote it",
        header.version, format_version);
  if (header.byte_order != Header{}.byte_order)
    return std::string("it is from a machine of another byte order");
  if (header.checksum != checksum_of(header)) return std::string("its header is damaged");
  if (header.version < format_version)
    return fmt::format(
        "its format, {}, is older than this program's, {}: resume with the program that wrote it",
        header.version, format_version);
  const std::array sizes{header.identity_size, header.mark_size, header.state_size};
  std::uint64_t body = 0;
  for (const auto size : sizes) {
    if (size > bytes.size()) return fmt::format("it is truncated after {} bytes", bytes.size());
    body += size;
  }
  const std::uint64_t whole = sizeof header + body + sizeof header.checksum;
  if (bytes.size() < whole) return fmt::format("it is truncated: it has {} of {} bytes", bytes.size(), whole);
  if (bytes.size() > whole) return fmt::format("it has {} extra bytes at its end", bytes.size() - whole);
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + sizeof header + body, sizeof checksum);
  if (checksum != XXH3_64bits(bytes.data() + sizeof header, body))
    return std::string("its content is damaged");

  FoundCheckpoint found{.file = path,
                        .serial = header.serial,
                        .step = header.step,
                        .t = header.t,
                        .identity = {},
                        .mark = {},
                        .bytes = {}};
  const auto* text = reinterpret_cast<const char*>(bytes.data() + sizeof header);
  found.identity.assign(text, header.identity_size);
  found.mark.assign(text + header.identity_size, header.mark_size);
  found.state_begin = sizeof header + header.identity_size + header.mark_size;
  bytes.resize(found.state_begin + header.state_size);
  found.bytes = std::move(bytes);
  return found;
}

}  // namespace

std::optional<FoundCheckpoint> find_checkpoint(const fs::path& folder, std::vector<std::string>& refused) {
  std::optional<FoundCheckpoint> newest;
  for (const std::uint64_t turn : {0, 1}) {
    const fs::path file = file_of(folder, turn);
    if (!fs::exists(file)) continue;
    auto read = read_checkpoint(file);
    if (const auto* wrong = std::get_if<std::string>(&read))
      refused.push_back(fmt::format("{}: {}", file.string(), *wrong));
    else if (auto& found = std::get<FoundCheckpoint>(read); !newest || found.serial > newest->serial)
      newest = std::move(found);
  }
  return newest;
}

CheckpointKeeper::CheckpointKeeper(fs::path folder, std::string identity, const FoundCheckpoint* last)
    : folder_(std::move(folder)), identity_(std::move(identity)), serial_(last ? last->serial + 1 : 0) {
  if (!last) remove_all();  // their higher numbers would make them look newer than the next ones
}

void CheckpointKeeper::keep(const StateWriter& state, std::int64_t step, double t, const std::string& mark) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) refuse_write(folder_, error.value());
  const auto pieces = state.pieces();
  Header header;
  header.serial = serial_;
  header.step = step;
  header.t = t;
  header.identity_size = identity_.size();
  header.mark_size = mark.size();
  for (const auto& piece : pieces) header.state_size += piece.size();
  header.checksum = checksum_of(header);

  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> checksum(XXH3_createState(),
                                                                                 XXH3_freeState);
  XXH3_64bits_reset(checksum.get());
  NewFile file(file_of(folder_, serial_));
  file.write(bytes_of(header));
  // Writes and sums block by block, so that each passes the cache once.
  constexpr std::size_t block = 1 << 20;
  const auto add = [&](std::span<const std::byte> bytes) {
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(block, bytes.size()))) {
      const auto part = bytes.first(std::min(block, bytes.size()));
      XXH3_64bits_update(checksum.get(), part.data(), part.size());
      file.write(part);
    }
  };
  add(bytes_of(identity_));
  add(bytes_of(mark));
  for (const auto& piece : pieces) add(piece);
  const std::uint64_t sum = XXH3_64bits_digest(checksum.get());
  file.write(bytes_of(sum));
  file.put_in_place();
  ++serial_;
}

void CheckpointKeeper::remove_all() const {
  std::error_code ignored;  // leftover files only take space
  for (const std::uint64_t turn : {0, 1}) {
    const fs::path file = file_of(folder_, turn);
    fs::remove(file, ignored);
    fs::remove(temporary_of(file), ignored);  // left by a run that was killed while writing
  }
  fs::remove(folder_, ignored);
}

}  // namespace myowave::solver
