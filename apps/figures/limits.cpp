// Beyond the paper, whose section on limitations asks for it: how the size of the sheet, what holds its
// edges, the law of the tension and the sign of the load act on drift and break-up.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "apps/figures/figures.hpp"
#include "apps/figures/measures.hpp"

namespace myowave::apps {
namespace {

constexpr std::array full_sizes{71, 81, 91, 101, 121, 151, 201, 251};
constexpr std::array quick_sizes{71, 101, 151};
constexpr double breakup_mu1 = 0.1;
constexpr double drift_mu1 = 0.12;

struct Edges {
  const char* name;
  const char* key;
  const char* value;
};
constexpr std::array<Edges, 3> edges{{{"rigid", "mechanics.on", "false"},
                                      {"load", "mechanics.edges", "\"load\""},
                                      {"fixed", "mechanics.edges", "\"fixed\""}}};

struct Tension {
  const char* law;
  double p;  // kN/m
};
constexpr std::array<Tension, 6> tensions{
    {{"delayed", 10}, {"delayed", 0}, {"delayed", -10}, {"printed", 10}, {"printed", 0}, {"printed", -10}}};

std::span<const int> sizes_of(Extent extent) {
  return extent == Extent::full ? std::span<const int>(full_sizes) : std::span<const int>(quick_sizes);
}
double duration(Extent extent) { return extent == Extent::full ? 1345 : 538; }  // 50 or 20 rotations
int starts_of(Extent extent) { return extent == Extent::full ? 3 : 1; }

SceneText spiral_scene(Extent extent) {
  SceneText scene = shipped_scene("drifting_spiral");
  return scene.set("time.t_end", fmt::format("{:.1f}", duration(extent)))
      .set("output.frames", "false")
      .set("output.every", "20.0")
      .set("output.tips_every", "0.5");
}

std::string size_name(int n, const Edges& edge, double mu1) {
  return fmt::format("size_{}_{}_{}", n, edge.name, mu1);
}

Job size_job(int n, const Edges& edge, double mu1, Extent extent) {
  SceneText scene = spiral_scene(extent);
  scene.set("grid.n", std::to_string(n))
      .set(edge.key, edge.value)
      .set("excitation.mu1", fmt::format("{}", mu1));
  if (mu1 == breakup_mu1) scene.set("time.stop_on", "[\"breakup\", \"death\"]");
  return {size_name(n, edge, mu1), scene.text(), {}};
}

std::string tension_name(const Tension& tension, int start) {
  return fmt::format("tension_{}_{}_start{}", tension.law, tension.p, start);
}

Job tension_job(const Tension& tension, int start, Extent extent) {
  SceneText scene = spiral_scene(extent);
  scene.set("tension.law", fmt::format("\"{}\"", tension.law))
      .set("mechanics.p", fmt::format("{:.1f}", tension.p));
  const double turned = std::round(50 * rotation_tu * start / 3) / 50;
  if (start > 0) scene.set("initial.precondition", fmt::format("[{{duration = {}}}]", turned));
  return {tension_name(tension, start), scene.text(), {}};
}

double until_edge(const RunResults& run) {
  const double reached = time_at_edge(run);
  return std::isfinite(reached) ? reached : run.summary().at("t").get<double>();
}

}  // namespace

std::vector<Job> sheet_size_jobs(Extent extent) {
  std::vector<Job> jobs;
  const auto sizes = sizes_of(extent);
  for (auto n = sizes.rbegin(); n != sizes.rend(); ++n)  // the longest first
    for (const Edges& edge : edges)
      for (const double mu1 : {drift_mu1, breakup_mu1}) jobs.push_back(size_job(*n, edge, mu1, extent));
  return jobs;
}

MadeFigure make_sheet_sizes(const Runs& runs, Extent extent) {
  Plot at_edge{
      .title = "Tip within ten nodes of the edge", .x = {"nodes a side", ""}, .y = {"time", "s", 0.0}},
      speed{
          .title = "Drift", .x = {"nodes a side", ""}, .y = {"speed of the core", "length units/t.u.", 0.0}},
      breakup{.title = "First break-up, mu1 = 0.1", .x = {"nodes a side", ""}, .y = {"time", "s", 0.0}};
  MadeFigure made{
      .caption = fmt::format("A settled spiral on sheets of different size, rigid, with loaded and with "
                             "fixed edges, over {:.0f} t.u.: when its tip comes to the edge and how "
                             "fast its core moves (mu1 = 0.12), and when it breaks up (mu1 = 0.1). "
                             "Points are missing where it did not happen.",
                             duration(extent)),
      .figure = {.columns = 3}};
  for (const Edges& edge : edges) {
    Series reached{.name = edge.name, .mark = Mark::linked_points}, drift = reached, broken = reached;
    std::string times;
    for (const int n : sizes_of(extent)) {
      const RunResults drifting = runs[size_name(n, edge, drift_mu1)],
                       breaking = runs[size_name(n, edge, breakup_mu1)];
      for (Series* series : {&reached, &drift, &broken}) series->x.push_back(n);
      reached.y.push_back(to_seconds(time_at_edge(drifting)));
      const bool whole = !std::isfinite(observable(drifting, "breakup_tu"));
      drift.y.push_back(whole ? core_speed(drifting, 0, until_edge(drifting)) : std::nan(""));
      broken.y.push_back(to_seconds(observable(breaking, "breakup_tu")));
      const double tu = time_at_edge(drifting);
      times += fmt::format("{}{}: {}", times.empty() ? "" : ", ", n,
                           !whole              ? "breaks up"
                           : std::isfinite(tu) ? fmt::format("{:.0f}", tu)
                                               : "never");
    }
    at_edge.series.push_back(reached);
    speed.series.push_back(drift);
    breakup.series.push_back(broken);
    made.rows.push_back(
        {.what = fmt::format("tip at the edge by nodes a side, t.u.: {}", edge.name),
         .paper = edge.name == std::string_view("load") ? "about 800 t.u., size not stated" : "",
         .ours = times,
         .samples = "1 start a size"});
  }
  made.figure.panels = {at_edge, speed, breakup};
  return made;
}

std::vector<Job> tension_law_jobs(Extent extent) {
  std::vector<Job> jobs;
  for (const Tension& tension : tensions)
    for (int start = 0; start < starts_of(extent); ++start)
      jobs.push_back(tension_job(tension, start, extent));
  return jobs;
}

MadeFigure make_tension_laws(const Runs& runs, Extent extent) {
  Plot at_edge{
      .title = "Tip within ten nodes of the edge", .x = {"edge load p", "kN/m"}, .y = {"time", "s", 0.0}},
      speed{.title = "Drift",
            .x = {"edge load p", "kN/m"},
            .y = {"speed of the core", "length units/t.u.", 0.0}};
  MadeFigure made{
      .caption = fmt::format("A contracting spiral on 81 x 81 nodes under both laws of the tension and "
                             "three edge loads, {} starts each: when its tip comes to the edge, and "
                             "how fast its core moves until then.",
                             starts_of(extent)),
      .figure = {.columns = 2}};
  for (const std::string_view law : {"delayed", "printed"}) {
    Series reached{.name = std::string(law), .mark = Mark::points}, drift = reached;
    for (const Tension& tension : tensions) {
      if (law != tension.law) continue;
      std::vector<double> times, speeds;
      for (int start = 0; start < starts_of(extent); ++start) {
        const RunResults run = runs[tension_name(tension, start)];
        times.push_back(time_at_edge(run));
        speeds.push_back(core_speed(run, 0, until_edge(run)));
        for (Series* series : {&reached, &drift}) series->x.push_back(tension.p);
        reached.y.push_back(to_seconds(times.back()));
        drift.y.push_back(speeds.back());
      }
      const auto at = mean_sd(times);
      made.rows.push_back({.what = fmt::format("law \"{}\", p = {} kN/m: tip at the edge", law, tension.p),
                           .paper = "",
                           .ours = fmt::format("{} of {} starts, {} t.u.; core {} length units/t.u.", at.n,
                                               times.size(), text_of(at, 0), text_of(mean_sd(speeds), 4)),
                           .samples = fmt::format("{} starts", times.size())});
    }
    at_edge.series.push_back(reached);
    speed.series.push_back(drift);
  }
  made.figure.panels = {at_edge, speed};
  return made;
}

}  // namespace myowave::apps
