// Names for contents: equal contents have equal names; different contents almost certainly do not.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace myowave::apps {

// 16 hexadecimal digits of XXH3.
std::string content_hash(std::string_view);

// Hash of the bytes of a file. Errors: InputError if it cannot be read.
std::string content_hash_of_file(const std::filesystem::path&);

}  // namespace myowave::apps
