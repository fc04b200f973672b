// What a sweep varies: the [[axis]] tables of a sweep file.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/toml_input.hpp"

namespace myowave::apps {

// A value on an axis.
struct AxisValue {
  std::string toml;              // what the scene gets
  nlohmann::ordered_json shown;  // what tables and plots show: the value, or its name
  toml::source_region place;     // in the sweep file
};

struct SweepAxis {
  std::string key;  // "section.key", or "section" where the values are whole tables
  std::vector<AxisValue> values;
  bool sampled = false;  // one of the axes of the latin hypercube
};

// The most runs of a sweep: their scenes are kept in memory.
inline constexpr std::size_t most_runs = 100'000;

struct LatinHypercube {
  std::size_t samples = 0;
  std::uint64_t seed = 0;
};

// Reads an [[axis]] table. `sampling`: what the file's [latin_hypercube] says; a value of each axis that it
// samples lies in each of `samples` equal parts of its range. Paths in values are relative to `folder`.
// Returns an axis without values where something is wrong, which is then among the problems.
SweepAxis read_axis(const toml::table&, const std::filesystem::path& folder,
                    const std::optional<LatinHypercube>& sampling, std::size_t number, Problems&);

// Reports the keys of a table that are none of `names`.
void require_known_keys(const toml::table&, std::string_view section,
                        const std::vector<std::string_view>& names, Problems&);

}  // namespace myowave::apps
