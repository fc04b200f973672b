// Names for what something is made of: equal contents have equal names, others with all but certainty not.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace myowave::apps {

// 16 hexadecimal digits of XXH3.
std::string content_hash(std::string_view);

// Of the file's bytes. Errors: InputError where it cannot be read.
std::string content_hash_of_file(const std::filesystem::path&);

}  // namespace myowave::apps
