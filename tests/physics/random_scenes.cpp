// Random scenes within the ranges of the schema: every run ends properly, and its result has the properties
// of the equations. MYOWAVE_SEEDS = "17" or "1001-4000" runs other seeds than the default ones.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "tests/support/random_run.hpp"

namespace myowave::test {
namespace {

using solver::InitialState;
using solver::Scene;

// Bounds for the scene's frames. Empty if the sheet deforms unevenly during the run, if steps may be divided,
// or if the intervals grow without limit.
std::optional<StateBox> bounds_of(const Scene& scene, const InitialState& initial, const Watch& watch) {
  if (scene.on_unstable == solver::OnUnstable::substep) return std::nullopt;
  StateBox box(initial);
  for (const auto& one : scene.initial.preconditions) {
    if (one.contraction) return std::nullopt;
    Scene stage = scene;
    stage.excitation = one.excitation;
    stage.tension = one.tension;
    stage.stimuli.clear();
    box.advance(stage, steps_of(one.duration, scene), 1);
  }
  // An explicit step of the whole; the split one's half step may overshoot it.
  if (scene.scheme == solver::Scheme::split) return std::nullopt;
  double stretch = 1;
  if (scene.mechanics && scene.metric != solver::MetricForm::none) {
    if (scene.mechanics->contraction) return std::nullopt;
    const double h = scene.mechanics->cells_per_element * scene.grid.dx;
    stretch = std::hypot(watch.nodes[2] - watch.nodes[0], watch.nodes[3] - watch.nodes[1]) / h;
  }
  box.advance(scene, steps_of(scene.time.t_end, scene), stretch);
  return box.finite() ? std::optional(box) : std::nullopt;
}

void expect_inside(const Interval& actual, const Interval& bounds, const char* what) {
  EXPECT_GE(actual.low, bounds.low) << what;
  EXPECT_LE(actual.high, bounds.high) << what;
}

void expect_sound_tips(const Scene& scene, const Watch& watch) {
  const double width = (scene.grid.columns - 1) * scene.grid.dx,
               height = (scene.grid.rows - 1) * scene.grid.dx;
  for (const auto& sample : watch.tip_samples)
    for (const auto& tip : sample.tips) {
      EXPECT_TRUE(tip.x >= 0 && tip.x <= width && tip.y >= 0 && tip.y <= height);
      EXPECT_EQ(std::abs(tip.charge), 1);
    }
}

void expect_sound_state(const Scene& scene, const Result& result) {
  const auto& [on_breakup, on_death] = scene.time.stop_on;
  const auto& seen = result.summary.observables;
  const bool ended_early = (on_death && seen.death_tu) || (on_breakup && seen.breakup_tu);
  EXPECT_TRUE(ended_early || result.summary.steps == steps_of(scene.time.t_end, scene));
  const Watch& watch = result.watch;
  EXPECT_TRUE(watch.finite);
  EXPECT_TRUE(all_finite(result.state.V) && all_finite(result.state.r) && all_finite(result.state.Ta));
  for (const auto& sample : watch.probe_samples) EXPECT_TRUE(all_finite(sample.values));
  constexpr double cube_overflows = 1e100;  // the winding number needs products of three values
  if (watch.V_range.size() < cube_overflows) expect_sound_tips(scene, watch);
  EXPECT_GT(watch.smallest_J, 0);
  for (const auto& area : watch.areas) {
    EXPECT_GT(area.min, 0);
    // The whole is a mean of its elements, up to the rounding of a sum of at most 144 of them.
    EXPECT_LE(area.min, area.total * (1 + 1e-13));
    EXPECT_GE(area.max, area.total * (1 - 1e-13));
    EXPECT_TRUE(std::isfinite(area.max));
  }
  EXPECT_EQ(watch.areas.empty(), !scene.mechanics);
}

TEST(RandomScenes, EndProperlyWithinTheBoundsOfTheEquations) {
  std::map<End, int> ends;
  int bounded = 0, tight = 0;
  for_random_scenes(300, random_scene, [&](const std::string& text) {
    const Scene scene = parsed(text);
    const InitialState initial = initial_state(scene);
    const Result result = run(scene, initial);
    ++ends[result.end];
    expect_orderly_end(result);
    EXPECT_NE(result.end, End::refused) << result.message;
    if (result.end != End::done) return;
    expect_sound_state(scene, result);
    const auto box = bounds_of(scene, initial, result.watch);
    if (!box) return;
    expect_inside(result.watch.V_range, box->V, "V");
    expect_inside(result.watch.r_range, box->r, "r");
    expect_inside(result.watch.Ta_range, box->Ta, "Ta");
    ++bounded;
    if (box->V.size() < 2) ++tight;
  });
  if (ends[End::done] > 100) {
    EXPECT_GE(4 * tight, ends[End::done]) << "the bounds are too loose";
  }
  fmt::print("{} runs done, {} failed with a message; V has a bound in {}, below 2 in {}\n", ends[End::done],
             ends[End::failed], bounded, tight);
}

TEST(RandomScenes, AtTheEndsOfTheirRangesEndProperly) {
  std::map<End, int> ends;
  for_random_scenes(300, random_extreme_scene, [&](const std::string& text) {
    Scene scene;
    try {
      scene = parsed(text);
    } catch (const solver::InputError& error) {
      ++ends[End::refused];
      EXPECT_THAT(error.what(), ::testing::ContainsRegex("^random\\.toml:[0-9]+:[0-9]+: "));
      return;
    }
    const Result result = run(scene, initial_state(scene));
    ++ends[result.end];
    expect_orderly_end(result);
    if (result.end == End::done) expect_sound_state(scene, result);
  });
  fmt::print("{} runs done, {} refused, {} failed with a message\n", ends[End::done], ends[End::refused],
             ends[End::failed]);
}

TEST(RandomScenes, TwiceAreBitwiseIdentical) {
  for_random_scenes(100, random_scene, [&](const std::string& text) {
    const Scene scene = parsed(text);
    const Result first = run(scene, initial_state(scene)), second = run(scene, initial_state(scene));
    EXPECT_EQ(first.message, second.message);
    EXPECT_TRUE(first.state.V == second.state.V && first.state.r == second.state.r &&
                first.state.Ta == second.state.Ta);
    EXPECT_TRUE(first.watch.nodes == second.watch.nodes);
  });
}

}  // namespace
}  // namespace myowave::test
