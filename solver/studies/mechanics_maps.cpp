#include "solver/studies/mechanics_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <utility>
#include <vector>

#include "kernels/elastic/kinematics.hpp"
#include "solver/base/error.hpp"
#include "solver/mechanics/ellipticity.hpp"
#include "solver/mechanics/rest_state.hpp"

namespace myowave::solver {
namespace {

using Host = Kokkos::DefaultHostExecutionSpace;
using Tension = GaussTension<Kokkos::HostSpace>;

constexpr double element_side = 6;  // length units, the paper's; the mechanics has no length of its own

constexpr std::array<const char*, 7> pattern_names{"uniform",      "front",  "front_within", "oblique",
                                                   "checkerboard", "spiral", "sharp_spiral"};

// Share of the largest tension at (x, y), in elements, on a sheet of `side` of them.
double share(TensionPattern pattern, double x, double y, int side) {
  const double middle = side / 2;
  switch (pattern) {
    case TensionPattern::uniform:
      return 1;
    case TensionPattern::front:
      return x < middle ? 1 : 0;
    case TensionPattern::front_within:
      return x < middle + 0.5 ? 1 : 0;
    case TensionPattern::oblique:
      return x + 0.37 * y < 0.685 * side ? 1 : 0;
    case TensionPattern::checkerboard:
      return (static_cast<int>(x) + static_cast<int>(y)) % 2 == 0 ? 1 : 0;
    case TensionPattern::spiral:
    case TensionPattern::sharp_spiral:
      break;
  }
  const double dx = x - 0.5 * side, dy = y - 0.5 * side;
  constexpr double turns = 3;  // over the side
  const double arm = std::sin(2 * std::numbers::pi * turns * std::hypot(dx, dy) / side + std::atan2(dy, dx));
  if (pattern == TensionPattern::sharp_spiral) return arm > 0 ? 1 : 0;
  constexpr double steepness = 3;
  return 0.5 + 0.5 * std::tanh(steepness * arm);
}

Tension make_tension(const MechanicsCase& c) {
  Tension Ta("myowave::solver::map_tension", c.side * c.side);
  for (int e = 0; e < c.side * c.side; ++e)
    for (int q = 0; q < elastic::gauss_points; ++q)
      Ta(e, q) = c.largest_Ta * share(c.pattern, e % c.side + elastic::gauss_coordinate(q % 2),
                                      e / c.side + elastic::gauss_coordinate(q / 2), c.side);
  return Ta;
}

bool sound(const SolveReport& report, double tolerance) {
  return report.residual < tolerance && report.min_J > 0 && std::isfinite(report.energy);
}

MechanicsOutcome outcome_of(const SolveReport& report) {
  if (report.not_elliptic > 0) return MechanicsOutcome::not_elliptic;
  if (report.ramp_steps > 0) return MechanicsOutcome::ramped;
  return report.shifts > 0 ? MechanicsOutcome::shifted : MechanicsOutcome::converged;
}

}  // namespace

MechanicsResult solve_case(const MechanicsCase& c) {
  const elastic::ElementGrid grid{.rows = c.side, .columns = c.side, .h = element_side};
  const Host host;
  const Tension Ta = make_tension(c);
  MechanicsResult result;
  try {
    Equilibrium<Host> sheet(host, grid, c.settings);
    if (c.from_rest) sheet.solve(host, Tension("myowave::solver::no_tension", grid.elements()), 0);
    result.report = sheet.solve(host, Ta, 0);
    result.margin = ellipticity_margin(grid, c.settings, sheet.nodes(), Ta);
    const SolveReport again = sheet.solve(host, Ta, 0);
    if (sound(result.report, c.settings.tolerance) && again.iterations == 0 &&
        (result.report.not_elliptic > 0) == (result.margin <= 0))
      result.outcome = outcome_of(result.report);
  } catch (const NumericalFailure& failure) {
    result.failure = failure.what();
    result.outcome =
        why_no_rest_state(c.settings) ? MechanicsOutcome::no_equilibrium : MechanicsOutcome::failed;
  } catch (const std::exception& other) {
    result.failure = other.what();
  }
  return result;
}

namespace {

MapTable empty_table(std::string name, std::string caption) {
  return {.name = std::move(name),
          .caption = std::move(caption),
          .columns = {{"tension", ""},
                      {"side", "elements"},
                      {"start", ""},
                      {"load", ""},
                      {"k_Ta", "kPa"},
                      {"p", "kN/m"},
                      {"c1", "kPa"},
                      {"c2", "kPa"},
                      {"iterations", ""},
                      {"factorizations", ""},
                      {"shifts", ""},
                      {"ramp_steps", ""},
                      {"min_J", ""},
                      {"margin", ""},
                      {"reason", ""}},
          .outcomes = {"converged", "needed shifts", "ramped", "loses ellipticity", "no equilibrium",
                       "failed with a reason", "unnoticed"},
          .rows = {},
          .findings = {},
          .view = {}};
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

MapRow make_row(const MechanicsCase& c, const MechanicsResult& result) {
  const MechanicsSettings& s = c.settings;
  MapRow row{.cells = {pattern_names[static_cast<std::size_t>(c.pattern)], double(c.side),
                       c.from_rest ? "rest" : "cold", s.load == Load::follower ? "follower" : "dead",
                       c.largest_Ta, s.p, s.c1, s.c2},
             .outcome = static_cast<std::size_t>(result.outcome),
             .handled = result.outcome != MechanicsOutcome::unnoticed};
  const SolveReport& report = result.report;
  if (result.failure.empty()) {
    for (const auto count : {report.iterations, report.factorizations, report.shifts, report.ramp_steps})
      row.cells.emplace_back(static_cast<double>(count));
    row.cells.insert(row.cells.end(), {report.min_J, result.margin, ""});
  } else {
    row.cells.resize(row.cells.size() + 6);  // no equilibrium to describe
    row.cells.emplace_back(one_line(result.failure));
  }
  return row;
}

// Solves every case in turn, and tells what the hardest took.
MapTable make_table(MapTable table, const std::vector<MechanicsCase>& cases, const MapProgress& progress) {
  std::int64_t most = 0;
  double least_J = 1;
  for (const auto& c : cases) {
    const MechanicsResult result = solve_case(c);
    table.rows.push_back(make_row(c, result));
    if (result.failure.empty()) {
      most = std::max(most, result.report.factorizations);
      least_J = std::min(least_J, result.report.min_J);
    }
    progress(static_cast<double>(table.rows.size()) / static_cast<double>(cases.size()));
  }
  table.findings.push_back(fmt::format(
      "Solves took at most {} factorisations; the smallest J of a corner is {:.2g}.", most, least_J));
  return table;
}

constexpr std::array loads{-30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 45.0};
constexpr std::array tensions{0.0, 10.0, 20.0, 30.0, 40.0, 47.9, 60.0, 80.0, 100.0, 150.0, 200.0};

// The spiral under a follower load: smallest J, in brackets where ellipticity is lost.
std::vector<std::string> load_table(const std::vector<MechanicsCase>& cases,
                                    const std::vector<MapRow>& rows) {
  constexpr std::size_t min_J = 12;  // column
  std::string head = "| p, kN/m |", rule = "|---|";
  for (const double k_Ta : tensions) {
    head += fmt::format(" {:g} |", k_Ta);
    rule += "---|";
  }
  std::vector<std::string> lines{head, rule};
  for (const double p : loads) {
    std::string line = fmt::format("| {:g} |", p);
    for (std::size_t n = 0; n < cases.size(); ++n) {
      const MechanicsCase& c = cases[n];
      if (c.pattern != TensionPattern::spiral || c.settings.load != Load::follower || c.settings.p != p)
        continue;
      const auto* J = std::get_if<double>(&rows[n].cells[min_J]);
      const bool elliptic = rows[n].outcome != static_cast<std::size_t>(MechanicsOutcome::not_elliptic);
      const std::string number = J == nullptr ? "failed" : fmt::format("{:.2f}", *J);
      line += elliptic ? fmt::format(" {} |", number) : fmt::format(" ({}) |", number);
    }
    lines.push_back(line);
  }
  return lines;
}

MechanicsSettings loaded(Load load, double p, elastic::MooneyRivlin material = {}) {
  MechanicsSettings settings{material};
  settings.load = load;
  settings.p = p;
  return settings;
}

}  // namespace

MapTable make_mechanics_load(const MapProgress& progress) {
  std::vector<MechanicsCase> cases;
  for (const auto pattern : {TensionPattern::uniform, TensionPattern::spiral})
    for (const Load load : {Load::follower, Load::dead})
      for (const double p : loads)
        for (const double k_Ta : tensions)
          cases.push_back({.pattern = pattern, .largest_Ta = k_Ta, .settings = loaded(load, p)});
  MapTable table = make_table(
      empty_table(
          "mechanics_load",
          "Cold solves of 25 x 25 elements, c1 = 2 and c2 = 6 kPa, under a uniform tension and under a "
          "spiral arm of it, against the largest tension and the edge load."),
      cases, progress);
  table.view = {.panels = {"tension", "load"}, .x = "p", .y = "k_Ta", .lines = {}, .y_in = ""};
  const auto lines = load_table(cases, table.rows);
  table.findings.insert(table.findings.end(), lines.begin(), lines.end());
  return table;
}

MapTable make_mechanics_material(const MapProgress& progress) {
  std::vector<MechanicsCase> cases;
  for (const double c1 : {0.0, 2.0, 8.0})
    for (const double p : {-10.0, 0.0, 3.0, 10.0})
      for (const double k_Ta : {20.0, 47.9})
        for (const double c2 : {6.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 0.001, 0.0})
          if (c1 + c2 > 0)
            cases.push_back({.largest_Ta = k_Ta, .settings = loaded(Load::follower, p, {c1, c2})});
  return make_table(
      empty_table("mechanics_material",
                  "Cold solves of 25 x 25 elements under a spiral arm of tension and a follower "
                  "load, against the material down to c1 = 0 or c2 = 0."),
      cases, progress);
}

MapTable make_mechanics_mesh(const MapProgress& progress) {
  std::vector<MechanicsCase> cases;
  for (const auto pattern :
       {TensionPattern::spiral, TensionPattern::sharp_spiral, TensionPattern::front,
        TensionPattern::front_within, TensionPattern::oblique, TensionPattern::checkerboard})
    for (const double k_Ta : {20.0, 47.9, 100.0})
      for (const bool from_rest : {false, true})
        for (const int side : {1, 2, 3, 10, 25, 50})
          cases.push_back({.pattern = pattern, .largest_Ta = k_Ta, .side = side, .from_rest = from_rest});
  for (const int side : {100, 250}) cases.push_back({.side = side});
  return make_table(
      empty_table("mechanics_mesh",
                  "Solves from a cold start and from rest, follower p = 10 kN/m, c1 = 2 and c2 = 6 "
                  "kPa, under fronts of tension sharper than an element, against the elements along "
                  "a side."),
      cases, progress);
}

}  // namespace myowave::solver
