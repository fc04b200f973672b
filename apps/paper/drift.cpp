// Figs 7 and 8: where the tip of a spiral goes, and its period, with and without contraction.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/paper/figures.hpp"
#include "apps/paper/measures.hpp"

namespace myowave::apps {
namespace {

constexpr std::array sheets{81, 121, 251};
constexpr int compared_sheet = 81;  // where the contracting spiral drifts as in the paper
constexpr int starts = 5;           // phases of the first turn at which contraction starts
// Columns between the core and the left edge, of the rigid spiral that is moved there. From 10 to 15 it takes
// up a distance of 11 and follows the edge; nearer, the edge throws it back into the sheet or ends it.
constexpr int edge_distance = 12;

double rotations(Extent extent) { return extent == Extent::full ? 50 : 25; }

SceneText spiral_scene(int n, bool contracts, Extent extent) {
  SceneText scene = shipped_scene("drifting_spiral");
  const double end = std::round(rotations(extent) * rotation_tu);
  return scene.set("grid.n", std::to_string(n))
      .set("time.t_end", fmt::format("{:.1f}", end))
      .set("mechanics.on", contracts ? "true" : "false")
      .set("output.frames", "false")
      .set("output.fields", "true")
      .set("output.every", "1.0")
      .set("output.from", fmt::format("{:.1f}", end))
      .set("output.tips_every", "0.5");
}

std::string name_of(int n, bool contracts) {
  return fmt::format("spiral_{}_{}", n, contracts ? "contracting" : "rigid");
}

std::string start_name(int start) {
  return start == 0 ? name_of(compared_sheet, true)
                    : fmt::format("{}_start{}", name_of(compared_sheet, true), start);
}

int starts_of(Extent extent) { return extent == Extent::full ? starts : 2; }

Job start_job(int start, Extent extent) {
  SceneText scene = spiral_scene(compared_sheet, true, extent);
  begin_at_phase(scene, start, starts);
  return {start_name(start), scene.text(), {}};
}

Job edge_job(Extent extent) {
  SceneText scene = spiral_scene(compared_sheet, false, extent);
  scene.set("initial.core_offset", fmt::format("[{}, 0]", edge_distance - (compared_sheet - 1) / 2));
  return {"spiral_edge_rigid", scene.text(), {}};
}

Plot path_plot(const RunResults& run, int n, std::string title) {
  const double side = (n - 1) * shipped_dx;
  return {.title = std::move(title),
          .x = {"X1", "length units", 0.0, side},
          .y = {"X2", "length units", 0.0, side},
          .series = {tip_paths(run, "")},
          .equal_scales = true};
}

std::string edge_text(const RunResults& run) {
  const double tu = time_at_edge(run), breakup = observable(run, "breakup_tu");
  if (std::isfinite(breakup)) return fmt::format("breaks up at {:.0f} t.u.", breakup);
  return std::isfinite(tu) ? fmt::format("{:.0f} t.u. ({:.0f} rotations)", tu, tu / rotation_tu) : "never";
}

Comparison edge_row(const Runs& runs, Extent extent) {
  std::vector<double> times;
  for (int start = 0; start < starts_of(extent); ++start)
    times.push_back(time_at_edge(runs[start_name(start)]));
  const auto reached = solver::mean_sd(times);
  const auto [first, last] = std::ranges::minmax(times);
  return {.what = "contracting spiral comes to the edge, 81 x 81",
          .paper = "after about 30 rotations, and follows it; another program 330 to 669 t.u.",
          .ours = fmt::format("{} of {} starts, {:.0f} to {:.0f} t.u. ({:.0f} to {:.0f} rotations)",
                              reached.n, times.size(), first, last, first / rotation_tu, last / rotation_tu),
          .difference = verdict(reached.n == static_cast<std::int64_t>(times.size())),
          .samples = fmt::format("{} starts", times.size()),
          .why =
              "the paper does not state the size of the sheet; on larger ones the spiral stays away (rows "
              "below)"};
}

Comparison sheet_row(const Runs& runs, int n) {
  const RunResults rigid = runs[name_of(n, false)], contracting = runs[name_of(n, true)];
  return {
      .what = fmt::format("tip within ten nodes of the edge, {0} x {0}: rigid, contracting", n),
      .paper = "never; about 30 rotations",
      .ours = fmt::format("{}; {}", edge_text(rigid), edge_text(contracting)),
      .difference = verdict(!std::isfinite(time_at_edge(rigid)) && std::isfinite(time_at_edge(contracting))),
      .samples = "1 start",
      .why = n == compared_sheet ? "" : "size of the sheet"};
}

Comparison speed_row(const Runs& runs, Extent extent) {
  constexpr double settling = 10 * rotation_tu;
  const RunResults edge = runs["spiral_edge_rigid"], drifting = runs[name_of(compared_sheet, true)];
  const double end = rotations(extent) * rotation_tu, reached = time_at_edge(drifting);
  const double rigid = core_speed(edge, settling, end), contracting = core_speed(drifting, reached, end);
  return {.what = "speed along the edge: rigid spiral that was moved there, contracting spiral",
          .paper = "rigid slower",
          .ours = fmt::format("{:.3f} and {:.3f} length units/t.u.", rigid, contracting),
          .difference = verdict(rigid < contracting),
          .samples = "1 start"};
}

// The four default probes, each a series.
Plot period_plot(std::span<const ProbePeriods> probes, std::string title) {
  // The same axis for both kinds: what differs is the spread.
  Plot plot{.title = std::move(title), .x = {"time", "s"}, .y = {"period", "ms", 200.0, 400.0}};
  for (std::size_t n = 0; n < probes.size(); ++n) {
    Series series{.name = fmt::format("point {}", n + 1), .x = in_seconds(probes[n].t), .mark = Mark::points};
    for (const double period : probes[n].period) series.y.push_back(period * ms_per_tu);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

std::vector<Job> tip_trajectory_jobs(Extent extent) {
  std::vector<Job> jobs;
  for (auto n = sheets.rbegin(); n != sheets.rend(); ++n)  // the longest first
    for (const bool contracts : {true, false})
      jobs.push_back({name_of(*n, contracts), spiral_scene(*n, contracts, extent).text(), {}});
  for (int start = 1; start < starts_of(extent); ++start) jobs.push_back(start_job(start, extent));
  jobs.push_back(edge_job(extent));
  return jobs;
}

MadeFigure make_tip_trajectories(const Runs& runs, Extent extent) {
  MadeFigure made{
      .caption = fmt::format("Pattern of V and path of the tip in material coordinates over {:.0f} "
                             "rotations at mu1 = 0.12: rigid, then contracting, from the same state; "
                             "a row a size of the sheet.",
                             rotations(extent)),
      .figure = {.columns = 4}};
  for (const int n : sheets) {
    for (const bool contracts : {false, true}) {
      const RunResults run = runs[name_of(n, contracts)];
      const std::string title = fmt::format("{0} x {0}, {1}", n, contracts ? "contracting" : "rigid");
      made.figure.panels.push_back(sheet_picture(run.last_frame(), title, SheetPicture::Shading::dark_above));
      made.figure.panels.push_back(path_plot(run, n, "tip"));
    }
  }
  made.rows.push_back(edge_row(runs, extent));
  for (const int n : sheets) made.rows.push_back(sheet_row(runs, n));
  made.rows.push_back(speed_row(runs, extent));
  return made;
}

std::vector<Job> spiral_period_jobs(Extent extent) {
  std::vector<Job> jobs;
  for (const int n : {251, compared_sheet})
    for (const bool contracts : {true, false})
      jobs.push_back({name_of(n, contracts), spiral_scene(n, contracts, extent).text(), {}});
  return jobs;
}

MadeFigure make_spiral_periods(const Runs& runs, Extent) {
  constexpr double from = 100;  // t.u.; the spiral has taken up its rhythm by then
  const auto rigid = periods_of(runs[name_of(compared_sheet, false)], from),
             contracting = periods_of(runs[name_of(compared_sheet, true)], from),
             large = periods_of(runs[name_of(251, true)], from);
  const auto rigid_ms = in_ms(all_periods(rigid)), contracting_ms = in_ms(all_periods(contracting)),
             large_ms = in_ms(all_periods(large));
  return {
      .caption = "Periods at four points, each at the time of its first upstroke, on 81 x 81 nodes.",
      .figure = {.columns = 2,
                 .panels = {period_plot(rigid, "Rigid"), period_plot(contracting, "Contracting")}},
      .rows = {period_row("period, rigid, 81 x 81", "269 +- 3 ms (n = 148); another program 268.4 +- 0.2",
                          rigid_ms, 269),
               period_row("period, contracting, 81 x 81",
                          "281 +- 29 ms (n = 144); another program 284.6 +- 22.6", contracting_ms, 281),
               test_row("period, contracting against rigid, 81 x 81", "p < 0.01, longer", contracting_ms,
                        rigid_ms),
               period_row("period, contracting, 251 x 251", "another program 277 +- 16 ms", large_ms, 277)}};
}

}  // namespace myowave::apps
