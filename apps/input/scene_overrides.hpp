// What is put over the tables of a scene file: values of `--set`, those of a sweep's axes, and those that a
// preset stands for.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "apps/input/toml_input.hpp"

namespace myowave::apps {

// Which nodes come from an override, and from which. Copies of toml++'s nodes do not know where they come
// from.
class Origins {
 public:
  // The node and all that is in it. `origin` is the key that was overridden.
  void mark(const toml::node&, std::string_view origin);
  // As problems have it: the override, or the place in the file.
  toml::source_region place(const toml::node&) const;
  // Of a key of the table.
  toml::source_region place(const toml::key&, const toml::table&) const;
  bool is_override(const toml::node&) const;
  bool is_from_preset(const toml::node&) const;

 private:
  void mark_all(const toml::node&, const std::shared_ptr<const std::string>& path);

  std::map<const toml::node*, std::shared_ptr<const std::string>> paths_;
};

// A scene's tables with what is put over them.
struct SceneTables {
  toml::table root;
  Origins origins{};
};

inline constexpr std::string_view preset_key = "accuracy.preset";

// Puts a copy of the value in the place of "section.key". What leads nowhere is added to the problems.
void apply_override(SceneTables&, const std::string& key, const toml::node& value, Problems&);
// The same of the text "section.key=value", in which a string needs no quotes.
void apply_override(SceneTables&, const std::string& text, Problems&);

// Adds the values of the chosen preset. What the scene names itself stays, but a preset of an override
// changes the file's values.
void apply_preset(SceneTables&);

// Leaves out what a preset of an override changes, so that the preset gives it where it stands in the file.
void leave_to_preset(SceneTables&);

}  // namespace myowave::apps
