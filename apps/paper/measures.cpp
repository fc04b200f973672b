#include "apps/paper/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "apps/report/difference_text.hpp"
#include "solver/analysis/statistics.hpp"

namespace myowave::apps {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct TipPath {
  std::vector<double> t, x, y;
};

// The path of each trajectory in tips.csv, by its number.
std::map<int, TipPath> paths_of(const RunResults& run) {
  const CsvTable tips = run.csv("tips.csv");
  const auto t = tips.numbers("t"), x = tips.numbers("x"), y = tips.numbers("y"),
             number = tips.numbers("trajectory");
  std::map<int, TipPath> paths;
  for (std::size_t n = 0; n < t.size(); ++n) {
    if (!std::isfinite(number[n])) continue;  // of raw initial data
    TipPath& path = paths[static_cast<int>(number[n])];
    path.t.push_back(t[n]);
    path.x.push_back(x[n]);
    path.y.push_back(y[n]);
  }
  return paths;
}

}  // namespace

std::vector<double> in_seconds(std::vector<double> tu) {
  for (double& t : tu) t = to_seconds(t);
  return tu;
}

std::vector<double> in_ms(std::vector<double> tu) {
  for (double& t : tu) t *= ms_per_tu;
  return tu;
}

std::string text_of(const solver::MeanSd& value, int decimals) {
  if (value.n == 0) return "-";
  if (value.n == 1) return fmt::format("{:.{}f}", value.mean, decimals);
  return fmt::format("{:.{}f} +- {:.{}f}", value.mean, decimals, value.sd, decimals);
}

std::string count_text(const solver::MeanSd& value) { return fmt::format("n = {}", value.n); }

std::string relative_difference(double ours, double papers) {
  return fmt::format("{:+.1f} %", 100 * (ours / papers - 1));
}

std::string verdict(bool holds) { return holds ? "agrees" : "differs"; }

Comparison period_row(std::string what, std::string paper, std::span<const double> periods_ms,
                      double papers_mean) {
  const auto ours = solver::mean_sd(periods_ms);
  return {.what = std::move(what),
          .paper = std::move(paper),
          .ours = fmt::format("{} ms", text_of(ours, 1)),
          .difference = relative_difference(ours.mean, papers_mean),
          .samples = count_text(ours)};
}

Comparison test_row(std::string what, std::string paper, std::span<const double> a,
                    std::span<const double> b) {
  DifferenceText text = difference_text(a, b);
  return {.what = std::move(what),
          .paper = std::move(paper),
          .ours = std::move(text.difference),
          .samples = std::move(text.samples)};
}

Series tip_paths(const RunResults& run, std::string name) {
  Series series{.name = std::move(name)};
  for (const auto& [number, path] : paths_of(run)) {
    series.x.insert(series.x.end(), path.x.begin(), path.x.end());
    series.y.insert(series.y.end(), path.y.begin(), path.y.end());
    series.x.push_back(none);
    series.y.push_back(none);
  }
  return series;
}

double time_at_edge(const RunResults& run) {
  double first = none;
  for (const double t : run.csv("trajectories.csv").numbers("boundary_tu"))
    if (std::isfinite(t) && !(t >= first)) first = t;
  return first;
}

void begin_at_phase(SceneText& scene, int start, int starts) {
  if (start == 0) return;
  const double turned = std::round(50 * rotation_tu * start / starts) / 50;  // a multiple of dt
  scene.set("initial.precondition", fmt::format("[{{duration = {}}}]", turned));
}

Point mean_tip(const RunResults& run, double from) {
  solver::RunningStatistics x, y;
  for (const auto& [number, path] : paths_of(run))
    for (std::size_t n = 0; n < path.t.size(); ++n) {
      if (path.t[n] < from) continue;
      x.add(path.x[n]);
      y.add(path.y[n]);
    }
  return {x.result().mean, y.result().mean};
}

double core_speed(const RunResults& run, double from, double to) {
  const auto paths = paths_of(run);
  if (paths.empty()) return none;
  const auto longest = std::ranges::max_element(paths, {}, [](const auto& p) { return p.second.t.size(); });
  const TipPath& path = longest->second;
  struct Turn {
    double x = 0, y = 0;
    int n = 0;
  };
  std::vector<Turn> turns;
  for (std::size_t n = 0; n < path.t.size(); ++n) {
    if (path.t[n] < from || path.t[n] > to) continue;
    const auto turn = static_cast<std::size_t>((path.t[n] - from) / rotation_tu);
    turns.resize(std::max(turns.size(), turn + 1));
    turns[turn].x += path.x[n];
    turns[turn].y += path.y[n];
    ++turns[turn].n;
  }
  if (!turns.empty()) turns.pop_back();  // not a whole one
  solver::RunningStatistics speed;
  for (std::size_t k = 1; k < turns.size(); ++k) {
    const Turn &a = turns[k - 1], &b = turns[k];
    if (a.n > 0 && b.n > 0) speed.add(std::hypot(b.x / b.n - a.x / a.n, b.y / b.n - a.y / a.n) / rotation_tu);
  }
  return speed.result().n > 0 ? speed.result().mean : none;
}

}  // namespace myowave::apps
