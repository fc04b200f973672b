// Beyond the paper, whose section on limitations asks for it: how the size of the sheet, what holds its
// edges, the law of the tension and the sign of the load act on drift and break-up.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "apps/paper/figures.hpp"
#include "apps/paper/measures.hpp"

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
constexpr int phases = 3;  // of a turn without contraction, that the starts are
int starts_of(Extent extent) { return extent == Extent::full ? phases : 1; }

SceneText spiral_scene(Extent extent) {
  SceneText scene = shipped_scene("drifting_spiral");
  return scene.set("time.t_end", fmt::format("{:.1f}", duration(extent)))
      .set("output.frames", "false")
      .set("output.every", "20.0")
      .set("output.tips_every", "0.5");
}

std::string size_name(int n, const Edges& edge, double mu1, int start) {
  return fmt::format("size_{}_{}_{}_start{}", n, edge.name, mu1, start);
}

Job size_job(int n, const Edges& edge, double mu1, int start, Extent extent) {
  SceneText scene = spiral_scene(extent);
  scene.set("grid.n", std::to_string(n))
      .set(edge.key, edge.value)
      .set("excitation.mu1", fmt::format("{}", mu1));
  if (mu1 == breakup_mu1) scene.set("time.stop_on", "[\"breakup\", \"death\"]");
  begin_at_phase(scene, start, phases);
  return {size_name(n, edge, mu1, start), scene.text(), {}};
}

std::string tension_name(const Tension& tension, int start) {
  return fmt::format("tension_{}_{}_start{}", tension.law, tension.p, start);
}

Job tension_job(const Tension& tension, int start, Extent extent) {
  SceneText scene = spiral_scene(extent);
  scene.set("tension.law", fmt::format("\"{}\"", tension.law))
      .set("mechanics.p", fmt::format("{:.1f}", tension.p));
  begin_at_phase(scene, start, phases);
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
      for (const double mu1 : {drift_mu1, breakup_mu1})
        for (int start = 0; start < starts_of(extent); ++start)
          jobs.push_back(size_job(*n, edge, mu1, start, extent));
  return jobs;
}

namespace {

// What the starts of one size and edge do.
struct SizeSeries {
  Series at_edge, speed, breakup;
  std::string text;  // of each size: how many came to the edge, how many broke up

  explicit SizeSeries(const char* name)
      : at_edge{.name = name, .mark = Mark::points}, speed(at_edge), breakup(at_edge) {}

  void add(int n, const Runs& runs, const Edges& edge, Extent extent) {
    int reached = 0, broke = 0;
    for (int start = 0; start < starts_of(extent); ++start) {
      const RunResults drifting = runs[size_name(n, edge, drift_mu1, start)],
                       breaking = runs[size_name(n, edge, breakup_mu1, start)];
      const bool whole = !std::isfinite(observable(drifting, "breakup_tu"));
      const double tu = whole ? time_at_edge(drifting) : std::nan("");
      reached += std::isfinite(tu) ? 1 : 0;
      broke += whole ? 0 : 1;
      for (Series* series : {&at_edge, &speed, &breakup}) series->x.push_back(n);
      at_edge.y.push_back(to_seconds(tu));
      speed.y.push_back(whole ? core_speed(drifting, 0, until_edge(drifting)) : std::nan(""));
      breakup.y.push_back(to_seconds(observable(breaking, "breakup_tu")));
    }
    text += fmt::format("{}{}: {}/{}", text.empty() ? "" : ", ", n, reached, broke);
  }
};

}  // namespace

MadeFigure make_sheet_sizes(const Runs& runs, Extent extent) {
  const int starts = starts_of(extent);
  Plot at_edge{.title = "Tip within ten nodes of the edge, mu1 = 0.12",
               .x = {"nodes a side", ""},
               .y = {"time", "s", 0.0}},
      speed{.title = "Drift, mu1 = 0.12",
            .x = {"nodes a side", ""},
            .y = {"speed of the core", "length units/t.u.", 0.0}},
      breakup{.title = "First break-up, mu1 = 0.1", .x = {"nodes a side", ""}, .y = {"time", "s", 0.0}};
  MadeFigure made{
      .caption = fmt::format("A settled spiral on sheets of different size, rigid, with loaded and with "
                             "fixed edges, over {:.0f} t.u., {} start(s) each: when its tip comes to "
                             "the edge, how fast its core moves until then, and when it breaks up. "
                             "A point is missing where it did not happen.",
                             duration(extent), starts),
      .figure = {.columns = 3}};
  for (const Edges& edge : edges) {
    SizeSeries series(edge.name);
    for (const int n : sizes_of(extent)) series.add(n, runs, edge, extent);
    at_edge.series.push_back(series.at_edge);
    speed.series.push_back(series.speed);
    breakup.series.push_back(series.breakup);
    made.rows.push_back(
        {.what = fmt::format("{}: starts that came to the edge / broke up, by nodes a side", edge.name),
         .paper = edge.name == std::string_view("rigid")  ? "none"
                  : edge.name == std::string_view("load") ? "1 of 1 at the edge, size not stated"
                                                          : "",
         .ours = series.text,
         .samples = fmt::format("{} start(s) a size", starts)});
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
      const auto at = solver::mean_sd(times);
      made.rows.push_back(
          {.what = fmt::format("law \"{}\", p = {} kN/m: tip at the edge", law, tension.p),
           .paper = "",
           .ours = fmt::format("{} of {} starts, {} t.u.; core {} length units/t.u.", at.n, times.size(),
                               text_of(at, 0), text_of(solver::mean_sd(speeds), 4)),
           .samples = fmt::format("{} starts", times.size())});
    }
    at_edge.series.push_back(reached);
    speed.series.push_back(drift);
  }
  made.figure.panels = {at_edge, speed};
  return made;
}

}  // namespace myowave::apps
