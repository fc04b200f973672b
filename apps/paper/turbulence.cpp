// Figs 9 and 10: turbulence at mu1 = 0.07 on 251 x 251 nodes, rigid and contracting from the same states.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/paper/figures.hpp"
#include "apps/paper/measures.hpp"

namespace myowave::apps {
namespace {

constexpr double precondition = 900;  // t.u.; a broken front has become turbulent by then
// Nodes that the end of the front is moved by from one start to the next, along both sides.
constexpr int between_fronts = 8;
constexpr double samples_every = 0.14;  // t.u., the paper's

int starts_of(Extent extent) { return extent == Extent::full ? 8 : 2; }
// Fig 10: 16000 samples; 50 rotations of about 450 ms.
double duration(Extent extent) { return extent == Extent::full ? 2240 : 560; }

std::string state_name(int start) { return fmt::format("turbulence_state{}", start); }
std::string run_name(int start, bool contracts) {
  return fmt::format("turbulence_{}_start{}", contracts ? "contracting" : "rigid", start);
}

SceneText scene_of(bool contracts) {
  SceneText scene = shipped_scene("contracting_turbulence");
  return scene.set("mechanics.on", contracts ? "true" : "false")
      .set("output.frames", "false")
      .set("output.fields", "true");
}

void keep_end_only(SceneText& scene, double end) {
  scene.set("time.t_end", fmt::format("{:.2f}", end))
      .set("output.every", "1.0")
      .set("output.from", fmt::format("{:.2f}", end));
}

void start_from(SceneText& scene, const std::string& job) {
  scene.set("initial", fmt::format("{{type = \"file\", file = \"../runs/{}/fields.h5\"}}", job));
}

// States of one kind that have nothing else in common: turbulence forgets where the front ended.
Job state_job(int start) {
  SceneText scene = scene_of(false);
  keep_end_only(scene, precondition);
  const int offset = between_fronts * start;
  scene.set("initial",
            fmt::format("{{type = \"broken_front\", width = 10, r0 = 1.5, offset = [{0}, {0}]}}", offset));
  return {state_name(start), scene.text(), {}};
}

Job run_job(int start, bool contracts, Extent extent) {
  SceneText scene = scene_of(contracts);
  keep_end_only(scene, duration(extent));
  scene.set("output.tips_every", fmt::format("{}", samples_every)).set("time.stop_on", "[\"death\"]");
  start_from(scene, state_name(start));
  return {run_name(start, contracts), scene.text(), {state_name(start)}};
}

// What is compared of one run: until activity died, where it did.
struct Pattern {
  std::vector<ProbePeriods> periods;
  std::vector<double> t, sources;
};

Pattern pattern_of(const RunResults& run) {
  const CsvTable table = run.csv("sources.csv");
  return {periods_of(run, 0), table.numbers("t"), table.numbers("sources")};
}

struct Kind {
  std::vector<Pattern> starts;
  std::vector<double> periods_ms;                              // of all starts
  std::vector<std::vector<double>> periods_by_start, sources;  // a series a start
  std::vector<double> mean_sources, mean_period_ms;            // of each start
  int died = 0;
};

Kind kind_of(const Runs& runs, bool contracts, Extent extent) {
  Kind kind;
  for (int start = 0; start < starts_of(extent); ++start) {
    const RunResults run = runs[run_name(start, contracts)];
    Pattern pattern = pattern_of(run);
    const auto periods = in_ms(all_periods(pattern.periods));
    kind.periods_ms.insert(kind.periods_ms.end(), periods.begin(), periods.end());
    kind.mean_period_ms.push_back(solver::mean_sd(periods).mean);
    kind.mean_sources.push_back(solver::mean_sd(pattern.sources).mean);
    kind.sources.push_back(pattern.sources);
    kind.died += std::isfinite(observable(run, "death_tu")) ? 1 : 0;
    kind.starts.push_back(std::move(pattern));
  }
  return kind;
}

// All samples, and how far the starts are apart: the paper's numbers are those of one start.
Comparison starts_row(const char* what, const char* papers, double number, std::span<const double> all,
                      std::span<const double> means, const Kind& kind) {
  const auto of_starts = solver::mean_sd(means);
  return {.what = what,
          .paper = papers,
          .ours = fmt::format("{}; starts {}", text_of(solver::mean_sd(all), 1), text_of(of_starts, 1)),
          .difference = relative_difference(of_starts.mean, number),
          .samples = fmt::format("n = {} in {} starts", all.size(), means.size()),
          .why = fmt::format("one start gives {:.1f} to {:.1f}; activity died in {} of {}",
                             *std::ranges::min_element(means), *std::ranges::max_element(means), kind.died,
                             means.size())};
}

std::vector<double> joined(const std::vector<std::vector<double>>& series) {
  std::vector<double> all;
  for (const auto& part : series) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Series period_points(const Pattern& pattern, std::string name) {
  Series points{.name = std::move(name), .mark = Mark::points};
  for (const auto& probe : pattern.periods)
    for (std::size_t n = 0; n < probe.t.size(); ++n) {
      points.x.push_back(to_seconds(probe.t[n]));
      points.y.push_back(probe.period[n] * ms_per_tu);
    }
  return points;
}

// Means of each start, with the spread within the start as error bars.
Plot starts_plot(const Kind& rigid, const Kind& contracting) {
  Plot plot{.title = "All starts", .x = {"start", ""}, .y = {"sources", "", 0.0}};
  for (const auto& [kind, name, shift] :
       {std::tuple{&rigid, "rigid", -0.1}, std::tuple{&contracting, "contracting", 0.1}}) {
    Series points{.name = name, .mark = Mark::points};
    for (std::size_t n = 0; n < kind->sources.size(); ++n) {
      const auto of_start = solver::mean_sd(kind->sources[n]);
      points.x.push_back(double(n) + 1 + shift);
      points.y.push_back(of_start.mean);
      points.error.push_back(of_start.sd);
    }
    plot.series.push_back(std::move(points));
  }
  return plot;
}

// The first start in which both sheets are alive at the end.
int shown_start(const Runs& runs, Extent extent) {
  const auto died = [&](int start, bool contracts) {
    return std::isfinite(observable(runs[run_name(start, contracts)], "death_tu"));
  };
  int shown = 0;
  while (shown + 1 < starts_of(extent) && (died(shown, false) || died(shown, true))) ++shown;
  return shown;
}

std::string lifetime(const RunResults& run) {
  const double death = observable(run, "death_tu");
  return std::isfinite(death) ? fmt::format("died at {:.0f} t.u.", death)
                              : fmt::format("t = {:.0f} ms", run.last_frame().t * ms_per_tu);
}

}  // namespace

std::vector<Job> turbulence_jobs(Extent extent) {
  std::vector<Job> jobs;
  for (int start = 0; start < starts_of(extent); ++start) {
    jobs.push_back(state_job(start));
    for (const bool contracts : {true, false}) jobs.push_back(run_job(start, contracts, extent));
  }
  return jobs;
}

MadeFigure make_turbulent_patterns(const Runs& runs, Extent extent) {
  MadeFigure made{.caption =
                      "Patterns at mu1 = 0.07 on 251 x 251 nodes, 25 x 25 elements, rigid and contracting "
                      "from the same turbulent state, dark where V > 0.6.",
                  .figure = {.columns = 2}};
  const int shown = shown_start(runs, extent);
  for (const bool contracts : {false, true}) {
    const RunResults run = runs[run_name(shown, contracts)];
    made.figure.panels.push_back(sheet_picture(
        run.last_frame(), fmt::format("{}, {}", contracts ? "contracting" : "rigid", lifetime(run)),
        SheetPicture::Shading::dark_above));
    made.rows.push_back({.what = fmt::format("sources at the end, {}", contracts ? "contracting" : "rigid"),
                         .paper = "several: a disorganised pattern",
                         .ours = fmt::format("{:.0f}", run.csv("sources.csv").numbers("sources").back()),
                         .samples = fmt::format("start {}", shown + 1)});
  }
  return made;
}

MadeFigure make_turbulence_statistics(const Runs& runs, Extent extent) {
  const Kind rigid = kind_of(runs, false, extent), contracting = kind_of(runs, true, extent);
  const auto shown = static_cast<std::size_t>(shown_start(runs, extent));
  const Pattern &of_rigid = rigid.starts[shown], &of_contracting = contracting.starts[shown];
  const auto sources_curve = [](const Pattern& pattern, const char* name) {
    return Series{.name = name, .x = in_seconds(pattern.t), .y = pattern.sources, .mark = Mark::steps};
  };
  const std::string start = fmt::format("start {}", shown + 1);
  MadeFigure made{.caption = fmt::format(
                      "Rigid and contracting turbulence at mu1 = 0.07: periods at four points and number "
                      "of sources, a sample every 1.4 ms, of one start, and the sources of all {} starts "
                      "(mean and standard deviation while there is activity).",
                      starts_of(extent)),
                  .figure = {.columns = 3,
                             .panels = {Plot{.title = "Periods, " + start,
                                             .x = {"time", "s"},
                                             .y = {"period", "ms", 0.0},
                                             .series = {period_points(of_rigid, "rigid"),
                                                        period_points(of_contracting, "contracting")}},
                                        Plot{.title = "Sources, " + start,
                                             .x = {"time", "s"},
                                             .y = {"sources", "", 0.0},
                                             .series = {sources_curve(of_rigid, "rigid"),
                                                        sources_curve(of_contracting, "contracting")}},
                                        starts_plot(rigid, contracting)}}};
  made.rows = {
      starts_row("period (ms), rigid", "440 +- 160 (n = 208); another program 432 +- 133", 440,
                 rigid.periods_ms, rigid.mean_period_ms, rigid),
      starts_row("period (ms), contracting", "470 +- 170 (n = 196); another program 440", 470,
                 contracting.periods_ms, contracting.mean_period_ms, contracting),
      starts_row("sources, rigid", "7.4 +- 4.1 (n = 16000); another program 7.2 +- 4.2", 7.4,
                 joined(rigid.sources), rigid.mean_sources, rigid),
      starts_row("sources, contracting", "7.1 +- 4.0 (n = 15987); another program 5.3 +- 1.2 (SE)", 7.1,
                 joined(contracting.sources), contracting.mean_sources, contracting),
      test_row("period (ms), contracting less rigid, " + start, "p < 0.05, longer",
               in_ms(all_periods(of_contracting.periods)), in_ms(all_periods(of_rigid.periods))),
      test_row("sources, contracting less rigid, " + start, "p < 0.01, fewer", of_contracting.sources,
               of_rigid.sources),
      test_row("period (ms), means of the starts", "longer", contracting.mean_period_ms,
               rigid.mean_period_ms),
      test_row("sources, means of the starts", "fewer", contracting.mean_sources, rigid.mean_sources)};
  return made;
}

}  // namespace myowave::apps
