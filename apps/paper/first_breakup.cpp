// Fig 11: when a spiral first breaks up, against mu1, rigid and contracting from the same states.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "apps/paper/figures.hpp"
#include "apps/paper/measures.hpp"

namespace myowave::apps {
namespace {

constexpr double longest = 2000;  // t.u.; a run ends before, where the spiral breaks up or dies
// Above 0.12 a sheet of this size keeps its spiral.
constexpr std::array full_mu1{0.0975, 0.1, 0.1025, 0.105, 0.1075, 0.11, 0.1125, 0.115, 0.1175, 0.12};
constexpr std::array quick_mu1{0.0975, 0.105, 0.1125};

// Where a pair of runs starts: the rigid spiral's own state, or a settled spiral with its core beside the
// middle.
struct Start {
  const char* name;
  std::optional<std::array<int, 2>> core_offset;
};
const std::array<Start, 4> starts{
    {{"P15", {}}, {"middle", {{0, 0}}}, {"right", {{20, 0}}}, {"up", {{0, 20}}}}};

std::span<const double> mu1_of(Extent extent) {
  return extent == Extent::full ? std::span<const double>(full_mu1) : std::span<const double>(quick_mu1);
}
std::span<const Start> starts_of(Extent extent) {
  return std::span<const Start>(starts).first(extent == Extent::full ? starts.size() : 2);
}

constexpr const char* state_name = "breakup_state_P15";

// The precondition of the scene, as a run of its own from which all values of mu1 start.
Job state_job() {
  SceneText scene = shipped_scene("rigid_spiral");
  scene.set("initial", "{type = \"broken_front\", width = 5, r0 = 1.5, offset = [-5, 40]}")
      .set("excitation.mu1", "0.15")
      .set("time.t_end", "270.0")
      .set("output.every", "270.0")
      .set("output.tips_every", "1.0")
      .set("output.frames", "false");
  return {state_name, scene.text(), {}};
}

std::string run_name(const Start& start, double mu1, bool contracts) {
  return fmt::format("breakup_{}_{:.4f}_{}", start.name, mu1, contracts ? "contracting" : "rigid");
}

Job run_job(const Start& start, double mu1, bool contracts) {
  SceneText scene = shipped_scene("rigid_spiral");
  scene.set("excitation.mu1", fmt::format("{}", mu1))
      .set("time.t_end", fmt::format("{:.1f}", longest))
      .set("time.stop_on", "[\"breakup\", \"death\"]")
      .set("mechanics.on", contracts ? "true" : "false")
      .set("output.every", "20.0")
      .set("output.tips_every", "1.0")
      .set("output.frames", "false")
      .set("output.fields", "false");
  std::vector<std::string> needs;
  if (start.core_offset) {
    const auto [columns, rows] = *start.core_offset;
    scene.set("initial", fmt::format("{{type = \"settled_spiral\", core_offset = [{}, {}]}}", columns, rows));
  } else {
    scene.set("initial", fmt::format("{{type = \"file\", file = \"../runs/{}/fields.h5\"}}", state_name));
    needs.push_back(state_name);
  }
  return {run_name(start, mu1, contracts), scene.text(), needs};
}

struct Outcome {
  double breakup, death;  // t.u., NaN where it did not come
  // Not before the end; a spiral that died first never broke up.
  double at_least() const {
    return std::isfinite(breakup) ? breakup : std::isfinite(death) ? death : longest;
  }
};

Outcome outcome_of(const RunResults& run) {
  return {observable(run, "breakup_tu"), observable(run, "death_tu")};
}

// Pairs from the same state: in how many the contracting spiral broke up later than the rigid one, or never.
struct Count {
  int later = 0, never = 0, earlier = 0, undecided = 0;

  void add(const Outcome& rigid, const Outcome& contracting) {
    const bool broke = std::isfinite(contracting.breakup);
    if (std::isfinite(rigid.breakup) && contracting.at_least() > rigid.breakup)
      ++(broke ? later : never);
    else if (broke && rigid.at_least() > contracting.breakup)
      ++earlier;
    else
      ++undecided;
  }
  int decided() const { return later + never + earlier; }
};

// The break-up of each run of a kind, and the last time of those that stayed whole.
struct Times {
  Series broke, whole;

  explicit Times(const std::string& kind, int colour)
      : broke{.name = kind, .mark = Mark::linked_points, .colour = colour},
        whole{.name = kind + ": none", .mark = Mark::rings, .colour = colour} {}
  void add(double mu1, const Outcome& outcome) {
    broke.x.push_back(mu1);
    broke.y.push_back(to_seconds(outcome.breakup));
    if (std::isfinite(outcome.breakup)) return;
    whole.x.push_back(mu1);
    whole.y.push_back(to_seconds(outcome.at_least()));
  }
};

Plot start_plot(const Runs& runs, const Start& start, Extent extent, Count& count) {
  Times rigid("rigid", 0), contracting("contracting", 1);
  for (const double mu1 : mu1_of(extent)) {
    const Outcome without = outcome_of(runs[run_name(start, mu1, false)]),
                  with = outcome_of(runs[run_name(start, mu1, true)]);
    count.add(without, with);
    rigid.add(mu1, without);
    contracting.add(mu1, with);
  }
  Plot plot{.title = fmt::format("start {}", start.name),
            .x = {"mu1", ""},
            .y = {"first break-up", "s", 0.0, to_seconds(longest * 1.05)}};
  for (const Times* times : {&rigid, &contracting}) {
    plot.series.push_back(times->broke);
    if (!times->whole.x.empty()) plot.series.push_back(times->whole);
  }
  return plot;
}

}  // namespace

std::vector<Job> first_breakup_jobs(Extent extent) {
  std::vector<Job> jobs{state_job()};
  for (const Start& start : starts_of(extent))
    for (const bool contracts : {true, false})
      for (const double mu1 : mu1_of(extent)) jobs.push_back(run_job(start, mu1, contracts));
  return jobs;
}

MadeFigure make_first_breakup(const Runs& runs, Extent extent) {
  MadeFigure made{
      .caption = fmt::format("Time of the first break-up on 121 x 121 nodes against mu1, rigid and "
                             "contracting from the same state; a panel a starting state. A spiral that "
                             "did not break up is shown where it died, or at the end of its run at "
                             "{:.0f} s.",
                             to_seconds(longest)),
      .figure = {.columns = 2}};
  Count count;
  for (const Start& start : starts_of(extent))
    made.figure.panels.push_back(start_plot(runs, start, extent, count));
  made.rows.push_back(
      {.what = "pairs in which the contracting spiral breaks up later than the rigid one, or never",
       .paper = "all; another program 20 of 24",
       .ours = fmt::format("{} later and {} never, of {}; {} undecided", count.later, count.never,
                           count.decided(), count.undecided),
       .difference = verdict(count.earlier == 0),
       .samples = fmt::format("{} pairs", count.decided() + count.undecided),
       .why = count.earlier == 0 ? "" : "depends on the start: the panels"});
  return made;
}

}  // namespace myowave::apps
