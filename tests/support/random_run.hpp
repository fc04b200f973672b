// Runs of random scenes in this process: how they end and what they show.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "apps/input/initial_state.hpp"
#include "apps/input/scene_file.hpp"
#include "solver/base/error.hpp"
#include "solver/run/run.hpp"
#include "tests/support/random_scene.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/state_box.hpp"

namespace myowave::test {

inline bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

// J of an element at each of its corners, from its nodes in the order (0,0), (0,1), (1,0), (1,1).
inline double smallest_corner_J(std::span<const double> nodes, int columns, int e, double h) {
  const int first = e / columns * (columns + 1) + e % columns;
  const std::array<int, 4> corner{first, first + 1, first + columns + 1, first + columns + 2};
  const auto side = [&](int from, int to, int axis) {
    return (nodes[2 * corner[to] + axis] - nodes[2 * corner[from] + axis]) / h;
  };
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [along_1, along_2] : {std::pair{std::pair{0, 1}, std::pair{0, 2}},
                                         {std::pair{0, 1}, std::pair{1, 3}},
                                         {std::pair{2, 3}, std::pair{0, 2}},
                                         {std::pair{2, 3}, std::pair{1, 3}}}) {
    const double F11 = side(along_1.first, along_1.second, 0), F21 = side(along_1.first, along_1.second, 1);
    const double F12 = side(along_2.first, along_2.second, 0), F22 = side(along_2.first, along_2.second, 1);
    smallest = std::min(smallest, F11 * F22 - F12 * F21);
  }
  return smallest;
}

// Keeps the last frame and the extremes over all.
struct Watch : RecordingSink {
  explicit Watch(const solver::Scene& watched) : scene(watched) { keep_fields = true; }

  void fields(const solver::Frame& frame) override {
    RecordingSink::fields(frame);
    V_range.cover(range_of(frame.V));
    r_range.cover(range_of(frame.r));
    Ta_range.cover(range_of(frame.Ta));
    finite = finite && all_finite(frame.V) && all_finite(frame.r) && all_finite(frame.Ta) &&
             all_finite(frame.nodes);
    if (!scene.mechanics) return;
    const double h = scene.mechanics->cells_per_element * scene.grid.dx;
    for (int e = 0; e < frame.element_rows * frame.element_columns; ++e)
      smallest_J = std::min(smallest_J, smallest_corner_J(frame.nodes, frame.element_columns, e, h));
  }

  const solver::Scene& scene;
  Interval V_range, r_range, Ta_range;
  bool finite = true;
  double smallest_J = std::numeric_limits<double>::infinity();
};

enum class End { done, refused, failed };

struct Result {
  explicit Result(const solver::Scene& scene) : watch(scene) {}
  End end = End::done;
  std::string message;
  solver::InitialState state;
  Watch watch;
  solver::RunSummary summary;
};

inline Result run(const solver::Scene& scene, const solver::InitialState& initial) {
  Result result(scene);
  try {
    result.state = solver::run(scene, initial, result.watch, result.summary);
  } catch (const solver::InputError& error) {
    result.end = End::refused;
    result.message = error.what();
  } catch (const solver::NumericalFailure& failure) {
    result.end = End::failed;
    result.message = failure.what();
  }
  return result;
}

inline solver::InitialState initial_state(const solver::Scene& scene) {
  solver::OutputSink nowhere;
  return apps::resolve_initial_state(scene, nowhere);
}

inline solver::Scene parsed(const std::string& text) { return apps::parse_scene(text, "random.toml"); }

// Calls test(text of a scene) for each seed; a failure shows the scene file that makes it again.
inline void for_random_scenes(std::uint64_t count, SceneText (*draw)(std::uint64_t),
                              const std::function<void(const std::string&)>& test) {
  const auto [first, last] = seeds(count);
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const std::string text = draw(seed).text();
    SCOPED_TRACE(fmt::format("MYOWAVE_SEEDS={}, this scene:\n{}", seed, text));
    test(text);
  }
}

inline std::int64_t steps_of(double duration, const solver::Scene& scene) {
  return std::llround(duration / scene.time.dt);
}

// With a message that says when and what to do, where it is no good one.
inline void expect_orderly_end(const Result& result) {
  if (result.end == End::done) return;
  if (result.end == End::refused) {
    EXPECT_THAT(result.message,
                ::testing::ContainsRegex("(time|grid|excitation|tension|mechanics|stimulus)\\.[a-z]"));
    return;
  }
  EXPECT_THAT(result.message, ::testing::ContainsRegex("t = [0-9.e+-]+ t\\.u\\."));
  EXPECT_THAT(result.message,
              ::testing::ContainsRegex("([Ss]horten|[Uu]se a smaller|[Ll]ower|[Rr]aise|[Bb]ring|Set) "));
  EXPECT_LE(result.summary.t, result.watch.scene.time.t_end + result.watch.scene.time.dt);
}

}  // namespace myowave::test
