// The kinds of the schema's keys, made from the place in a Target that a key is written to.
#pragma once

#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "apps/input/schema.hpp"

namespace myowave::apps::kinds {

inline constexpr Range any{};
inline constexpr Range positive{.low = 0, .low_open = true};
inline constexpr Range not_negative{.low = 0};
inline constexpr double largest_int = std::numeric_limits<int>::max();

// `at` names the place of the value, for reading and for writing.
template <class At>
Number number(At at, Range range) {
  return {at, [at](Target& target, double value) { at(target) = value; }, range};
}

template <class At>
Integer integer(At at, Range range) {
  using Stored = std::remove_cvref_t<std::invoke_result_t<At, const Target&>>;
  return {[at](const Target& target) { return static_cast<std::int64_t>(at(target)); },
          [at](Target& target, std::int64_t value) { at(target) = static_cast<Stored>(value); }, range};
}

template <class At>
Flag flag(At at) {
  return {at, [at](Target& target, bool value) { at(target) = value; }};
}

// `names` in the order of the enumerators.
template <class At>
Choice choice(std::vector<std::string_view> names, At at) {
  using Enum = std::remove_cvref_t<std::invoke_result_t<At, const Target&>>;
  return {std::move(names), [at](const Target& target) { return static_cast<std::size_t>(at(target)); },
          [at](Target& target, std::size_t value) { at(target) = static_cast<Enum>(value); }};
}

template <class At>
Pair pair(std::string_view parts, At at, Range range) {
  return {parts, at, [at](Target& target, std::array<int, 2> value) { at(target) = value; }, range};
}

Choice tension_law();
// Factor on both rates of the law, which stands before it in the section.
Number tension_eps0();
// In place of the law's, which is in force where the key is not given.
Number tension_rate(double cell::ActiveTensionParameters<double>::*rate,
                    std::optional<double> solver::TensionSettings::*own);
Choice preset();
std::vector<Note> preset_notes();
Choices stop_on();
// Also of the two that follow it unless they are given: tips_every, probes_every.
Number output_every();
Pair window();

}  // namespace myowave::apps::kinds
