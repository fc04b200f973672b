// What scene and sweep files have in common: TOML whose every error has its place.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace myowave::apps {

// Begins the source of a node that comes from an override of the command line, and the message about it.
inline constexpr std::string_view override_mark = "--set ";
bool is_override(const toml::source_region&);

// Collects everything that is wrong, in the order of the file and then of the command line.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  // "file:line:column: message" or "--set key: message".
  void add(const toml::source_region& where, const std::string& message);
  void add_override(std::string_view key, const std::string& message);
  // Those of another file. `of_override` gets the key and the message of those that overrides have.
  void add_rest(const Problems& others,
                const std::function<void(const std::string& key, const std::string& message)>& of_override);
  std::size_t size() const { return lines_.size(); }
  // Errors: InputError, a line for each.
  void throw_if_any() const;

 private:
  std::string file_;
  std::set<std::tuple<bool, unsigned, unsigned, std::string>> lines_;
};

// Names and values as messages show them: short, without control characters.
std::string printable(std::string_view text);
std::string shown(const toml::node&);

// In quotes.
std::string toml_string(std::string_view text);
// The value on one line, as an override gives it.
std::string toml_value(const toml::node&);

// Reports the keys of a table that are none of `names`.
void require_known_keys(const toml::table&, std::string_view section,
                        const std::vector<std::string_view>& names, Problems&);

// Errors: InputError where there is no such file, or one that is no `kind` ("scene", "sweep").
std::string toml_text(const std::filesystem::path& file, std::string_view kind);
// Errors: InputError with the place where the text is no TOML.
toml::table parse_toml(std::string_view text, const std::filesystem::path& file, Problems&);

}  // namespace myowave::apps
