// Fig 2: the whole sheet stimulated at once, with both laws of the tension, and APD restitution.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/paper/figures.hpp"
#include "apps/paper/measures.hpp"
#include "solver/analysis/cell_protocol.hpp"
#include "solver/mechanics/equibiaxial.hpp"

namespace myowave::apps {
namespace {

constexpr double cycle = 33;  // t.u.; 330 ms
constexpr int shown_beats = 2;
constexpr double k_Ta = 47.9;  // kPa, Table 1

int beats(Extent extent) { return extent == Extent::full ? 70 : 55; }  // the first 50 are transient

Job pacing_job(std::string_view law, Extent extent) {
  const double end = cycle * beats(extent);
  SceneText scene = shipped_scene("uniform_pacing");
  scene.set("tension.law", fmt::format("\"{}\"", law))
      .set("time.t_end", fmt::format("{:.1f}", end))
      .set("output.every", "0.2")
      .set("output.from", fmt::format("{:.1f}", end - shown_beats * cycle))
      .set("output.probes_every", "0.2");
  return {fmt::format("pacing_{}", law), scene.text(), {}};
}

struct Course {
  Plot plot;
  double shortening = 0, shortening_at = 0, tension_at = 0,
         V_at = 0;  // of the last beat; t.u. after its stimulus
};

Course course_of(const RunResults& run, std::string title) {
  const CsvTable area = run.csv("area.csv"), probes = run.csv("probes.csv");
  const auto t_area = area.numbers("t"), ratio = area.numbers("area");
  const auto t = probes.numbers("t"), V = probes.numbers("V0"), Ta = probes.numbers("Ta0");
  const double begin = t_area.front(), last_beat = begin + (shown_beats - 1) * cycle;
  Course course{.plot = {.title = std::move(title), .x = {"time", "ms"}, .y = {"V, L, T / k_Ta", ""}}};
  Series v{.name = "V"}, l{.name = "L"}, ta{.name = "T / k_Ta", .dashed = true};
  double largest_V = 0, largest_Ta = 0;
  // Areas are relative to the loaded sheet at rest, shortening to the undeformed one.
  const double rest_stretch = solver::equibiaxial_stretch(solver::MechanicsSettings{}, 0).value();
  for (std::size_t n = 0; n < t_area.size(); ++n) {
    l.x.push_back((t_area[n] - begin) * ms_per_tu);
    l.y.push_back(1 - rest_stretch * std::sqrt(ratio[n]));
    if (t_area[n] < last_beat || l.y.back() <= course.shortening) continue;
    course.shortening = l.y.back();
    course.shortening_at = t_area[n] - last_beat;
  }
  for (std::size_t n = 0; n < t.size(); ++n) {
    if (t[n] < begin) continue;
    for (Series* series : {&v, &ta}) series->x.push_back((t[n] - begin) * ms_per_tu);
    v.y.push_back(V[n]);
    ta.y.push_back(Ta[n] / k_Ta);
    if (t[n] < last_beat) continue;
    if (V[n] > largest_V) largest_V = V[n], course.V_at = t[n] - last_beat;
    if (Ta[n] > largest_Ta) largest_Ta = Ta[n], course.tension_at = t[n] - last_beat;
  }
  course.plot.series = {v, l, ta};
  return course;
}

// Restitution by the dynamic protocol, and the longest cycle length at which long and short durations
// alternate: there its slope against the diastolic interval passes 1.
struct Restitution {
  Series curve;
  double alternans = std::nan("");  // t.u.
};

Restitution restitution_of(double mu1, Extent extent) {
  solver::RestitutionProtocol protocol;
  protocol.cell.excitation.mu1 = mu1;
  if (extent == Extent::quick) protocol.pulses = 30;
  Restitution found{.curve = {.name = fmt::format("mu1 = {}", mu1), .mark = Mark::linked_points}};
  for (const auto& point : solver::restitution(protocol)) {
    if (point.capture != solver::RestitutionPoint::Capture::one_to_one) continue;
    if (point.alternates && !(found.alternans >= point.cycle_length)) found.alternans = point.cycle_length;
    // Both durations where long and short ones alternate.
    const std::size_t shown = point.alternates ? 2 : 1;
    for (std::size_t n = 0; n < shown && n < point.beats.size(); ++n) {
      found.curve.x.push_back(point.cycle_length * ms_per_tu);
      found.curve.y.push_back(point.beats[n].apd90 * ms_per_tu);
    }
  }
  return found;
}

}  // namespace

std::vector<Job> uniform_pacing_jobs(Extent extent) {
  return {pacing_job("delayed", extent), pacing_job("printed", extent)};
}

MadeFigure make_uniform_pacing(const Runs& runs, Extent extent) {
  const Course delayed = course_of(runs["pacing_delayed"], "Law \"delayed\""),
               printed = course_of(runs["pacing_printed"], "Law \"printed\" (Eq 23)");
  const Restitution ours = restitution_of(0.12, extent), steep = restitution_of(0.07, extent);
  const Plot restitution{.title = "Dynamic restitution",
                         .x = {"cycle length", "ms"},
                         .y = {"APD90", "ms"},
                         .series = {ours.curve, steep.curve}};
  const std::string one_beat = fmt::format("beat {}", beats(extent));
  const auto after = [](double tu) { return fmt::format("{:.0f} ms after the stimulus", tu * ms_per_tu); };
  return {
      .caption =
          "Potential V, shortening L of the undeformed length and active tension T under uniform stimuli "
          "every 330 ms, with both laws of the tension; dynamic restitution at 90 % of repolarisation, "
          "and beside it at the mu1 of break-up.",
      .figure = {.columns = 3, .panels = {delayed.plot, printed.plot, restitution}},
      .rows = {
          {.what = "largest shortening, law \"delayed\"",
           .paper = "approximately 25 %",
           .ours = fmt::format("{:.1f} %", 100 * delayed.shortening),
           .difference = relative_difference(delayed.shortening, 0.25),
           .samples = one_beat},
          {.what = "when: shortening, tension, V",
           .paper = "shortening late against V, together with tension",
           .ours = fmt::format("{:.0f}, {:.0f}, {:.0f} ms after the stimulus", 10 * delayed.shortening_at,
                               10 * delayed.tension_at, 10 * delayed.V_at),
           .difference = verdict(delayed.shortening_at > delayed.V_at + 5 &&
                                 std::abs(delayed.shortening_at - delayed.tension_at) < 1),
           .samples = one_beat},
          {.what = "largest shortening, law \"printed\"",
           .paper = "approximately 25 %",
           .ours = fmt::format("{:.1f} %, {}", 100 * printed.shortening, after(printed.shortening_at)),
           .difference = relative_difference(printed.shortening, 0.25),
           .samples = one_beat,
           .why = "Eq 23 as printed makes tension follow V at once, and therefore higher; the law alone was "
                  "changed between the two runs"},
          {.what = "longest cycle length with alternans, mu1 = 0.12 and 0.07",
           .paper = "restitution steeper at 0.07",
           .ours =
               fmt::format("{:.0f} and {:.0f} ms", ours.alternans * ms_per_tu, steep.alternans * ms_per_tu),
           .difference = verdict(steep.alternans > ours.alternans),
           .samples = "cycle lengths 10 ms apart"}}};
}

}  // namespace myowave::apps
