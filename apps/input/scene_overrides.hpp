// What is put over the tables of a scene file: values of `--set`, and those that a preset stands for.
#pragma once

#include <string>
#include <string_view>

#include "apps/input/toml_input.hpp"

namespace myowave::apps {

inline constexpr std::string_view preset_key = "accuracy.preset";

// Puts "section.key=value" in its place. What leads nowhere is added to the problems.
void apply_override(toml::table& root, const std::string& text, Problems&);

// Adds the values of the chosen preset. What the scene names itself stays, but a preset of an override
// changes the file's values.
void apply_preset(toml::table& root);
bool is_from_preset(const toml::node&);

// Leaves out what a preset of an override changes, so that the preset gives it where it stands in the file.
void leave_to_preset(toml::table& root);

}  // namespace myowave::apps
