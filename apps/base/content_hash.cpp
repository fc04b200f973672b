#include "apps/base/content_hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <fstream>
#include <memory>

#include "solver/base/error.hpp"

namespace myowave::apps {

std::string content_hash(std::string_view content) {
  return fmt::format("{:016x}", XXH3_64bits(content.data(), content.size()));
}

std::string content_hash_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  XXH3_64bits_reset(state.get());
  for (std::array<char, 1 << 16> part{}; file;) {
    file.read(part.data(), part.size());
    XXH3_64bits_update(state.get(), part.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof()) throw solver::InputError(fmt::format("{}: cannot be read", path.string()));
  return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

}  // namespace myowave::apps
