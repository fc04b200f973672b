// Fig 1: the cell model with Aliev and Panfilov's own parameters, without tissue.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/paper/figures.hpp"
#include "apps/paper/measures.hpp"
#include "solver/analysis/cell_protocol.hpp"

namespace myowave::apps {
namespace {

constexpr double cycle_ms = 312;  // Fig 1a
constexpr double ms = solver::aliev_panfilov_ms_per_tu;

Plot time_course(const solver::PacedCell& cell) {
  constexpr int pulses = 20, shown = 2;
  const auto course = solver::pace_cell(cell, cycle_ms / ms, pulses, 0.05);
  const double begin = (pulses - shown) * cycle_ms / ms;
  const double largest_r = *std::ranges::max_element(course.r);
  Series V{.name = "V"}, r{.name = fmt::format("r / {:.2f}", largest_r), .dashed = true};
  for (std::size_t n = 0; n < course.t.size(); ++n) {
    if (course.t[n] < begin) continue;
    const double t = (course.t[n] - begin) * ms;
    V.x.push_back(t);
    V.y.push_back(course.V[n]);
    r.x.push_back(t);
    r.y.push_back(course.r[n] / largest_r);
  }
  return {.title = "Paced at 312 ms", .x = {"time", "ms"}, .y = {"V, r", "", 0.0}, .series = {V, r}};
}

Plot normalised_restitution(const solver::PacedCell& cell, Extent extent) {
  solver::RestitutionProtocol protocol;
  protocol.cell = cell;
  protocol.longest = 80;
  protocol.shortest = 22;
  protocol.step = 2;
  if (extent == Extent::quick) protocol.pulses = 20;
  const auto points = solver::restitution(protocol);
  Series curve{.name = "", .mark = Mark::linked_points};
  for (const auto& point : points) {
    if (point.capture != solver::RestitutionPoint::Capture::one_to_one) continue;
    curve.x.push_back(point.cycle_length * ms);
    curve.y.push_back(point.apd90() / points.front().apd90());
  }
  return {.title = "Restitution",
          .x = {"cycle length", "ms"},
          .y = {"APD90 / longest APD90", ""},
          .series = {curve}};
}

}  // namespace

std::vector<Job> single_cell_jobs(Extent) { return {}; }

MadeFigure make_single_cell(const Runs&, Extent extent) {
  const solver::PacedCell cell = solver::aliev_panfilov_cell();
  const double apd = solver::time_to_fall(cell, {.V = 0.5}, 0.5);
  constexpr double quoted = 25.58;  // Aliev and Panfilov 1996
  return {.caption =
              "Aliev and Panfilov's own parameters (a = b = 0.15, eps = 0.002, mu1 = 0.2; 12.9 ms a t.u.). "
              "(a) V and r, scaled to its maximum, paced at 312 ms. (b) Action potential duration against "
              "cycle length under the dynamic protocol. The paper's crosses are measurements on dogs, "
              "which are not ours to draw.",
          .figure = {.columns = 2, .panels = {time_course(cell), normalised_restitution(cell, extent)}},
          .rows = {
              {.what = "duration of an action potential (V > 0.5 from V = 0.5, r = 0)",
               .paper = "25.58 t.u. (330 ms)",
               .ours = fmt::format("{:.3f} t.u. ({:.0f} ms)", apd, apd * ms),
               .difference = relative_difference(apd, quoted),
               .samples = "1",
               .why = fmt::format(
                   "start and level of the quoted number are not stated, and matter more: from "
                   "V = 1 it is {:.2f}, above V = 0.1 it is {:.2f} t.u.",
                   solver::time_to_fall(cell, {.V = 1}, 0.5), solver::time_to_fall(cell, {.V = 0.5}, 0.1))}}};
}

}  // namespace myowave::apps
