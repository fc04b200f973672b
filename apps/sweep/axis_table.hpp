// Axes of a sweep from TOML that is parsed already.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "apps/input/toml_input.hpp"
#include "apps/sweep/sweep_axis.hpp"

namespace myowave::apps {

// The most runs of a sweep: their scenes are kept in memory.
inline constexpr std::size_t most_runs = 100'000;

struct LatinHypercube {
  std::size_t samples = 0;
  std::uint64_t seed = 0;
};

// An axis with what the scene gets for each of its values.
struct ReadAxis {
  SweepAxis axis;
  toml::array nodes{};
};

// Reads an [[axis]] table. `sampling`: what the file's [latin_hypercube] says; a value of each axis that it
// samples lies in each of `samples` equal parts of its range. Paths in values are relative to `folder`.
// Returns an axis without values where something is wrong, which is then among the problems.
ReadAxis read_axis(const toml::table&, const std::filesystem::path& folder,
                   const std::optional<LatinHypercube>& sampling, std::size_t number, Problems&);

// As problems have it.
inline toml::source_region region_of(const Place& place) {
  const toml::source_position at{place.line, place.column};
  return {at, at, nullptr};
}

}  // namespace myowave::apps
