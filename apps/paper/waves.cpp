// Figs 3 to 6: waves from a stimulus in the middle against a spiral in the same place, and the areas that
// they leave the sheet.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/paper/figures.hpp"
#include "apps/paper/measures.hpp"

namespace myowave::apps {
namespace {

constexpr int nodes = 71;             // 7 x 7 elements: Fig 5 samples "the 7 adjacent elements" of a row
constexpr int elements = 7;           // a row
constexpr double first_frame = 1500;  // t.u.; Figs 3 and 4 start at 15 s
constexpr double areas_from = 1000;   // t.u.; Fig 5 samples 10 to 15 s
constexpr double areas_every = 0.6;   // t.u., 6 ms
constexpr int frames = 4;

SceneText radial() {
  SceneText scene = shipped_scene("point_stimulus");
  return scene.set("output.frames", "false");
}

SceneText spiral() {
  SceneText scene = shipped_scene("drifting_spiral");
  return scene.set("output.frames", "false").set("grid.n", std::to_string(nodes));
}

constexpr double frame_grid = 1.5;      // t.u.; the times of all frames are multiples of it
constexpr double radial_spacing = 9;    // t.u. between frames: 90 ms
constexpr double spiral_spacing = 4.5;  // 45 ms

void show_frames(SceneText& scene, double spacing) {
  scene.set("time.t_end", fmt::format("{:.1f}", first_frame + (frames - 1) * spacing))
      .set("output.every", fmt::format("{:.1f}", frame_grid))
      .set("output.from", fmt::format("{:.1f}", first_frame))
      .set("output.fields", "true");
}

// Areas as the paper samples them, the feedback on conduction switched off.
void sample_areas(SceneText& scene) {
  scene.set("feedback.metric", "\"none\"")
      .set("mechanics.interval", "30")
      .set("time.t_end", "1500.0")
      .set("output.every", fmt::format("{:.1f}", areas_every))
      .set("output.from", fmt::format("{:.1f}", areas_from))
      .set("output.element_areas", "true");
}

std::vector<Panel> frame_panels(const RunResults& run, double spacing) {
  std::vector<Panel> panels;
  const auto times = run.frame_times();
  for (std::size_t n = 0; n < times.size(); ++n) {
    const double after = (times[n] - first_frame) / spacing;
    if (std::abs(after - std::round(after)) > 1e-6) continue;
    panels.push_back(sheet_picture(run.frame(n), fmt::format("t = {:.0f} ms", times[n] * ms_per_tu),
                                   SheetPicture::Shading::dark_above));
  }
  return panels;
}

// A run of Figs 5 and 6, and what it does otherwise than they to show what its areas depend on.
struct AreaRun {
  enum class Wave { radial, spiral } wave = Wave::radial;
  int offset = 0;                 // nodes from the middle, both ways; the paper's Fig 6b: -8
  std::array<int, 2> more{0, 0};  // [columns, rows], nodes more
  double b = 0.1;
  double radius = 3;  // of the stimulus, nodes

  std::string name() const {
    return fmt::format("areas_{}_{}_{}_b{}_r{}", wave == Wave::radial ? "radial" : "spiral", offset + more[0],
                       offset + more[1], b, radius);
  }
};

Job area_job(const AreaRun& run) {
  const bool from_stimulus = run.wave == AreaRun::Wave::radial;
  SceneText scene = from_stimulus ? radial() : spiral();
  sample_areas(scene);
  scene.set("excitation.b", fmt::format("{}", run.b));
  const int columns = run.offset + run.more[0], rows = run.offset + run.more[1];
  if (!from_stimulus) scene.set("initial.core_offset", fmt::format("[{}, {}]", columns, rows));
  constexpr int middle = (nodes - 1) / 2, stimuli = 5;  // of the scene
  for (int n = 0; from_stimulus && n < stimuli; ++n)
    scene.set(fmt::format("stimulus.{}.region", n),
              fmt::format("{{center = [{}, {}], radius = {}}}", middle + columns, middle + rows, run.radius));
  return {run.name(), scene.text(), {}};
}

using Wave = AreaRun::Wave;
constexpr int off = -8;
// The numbers of another program are those of b = 0.11.
constexpr double other_b = 0.11;

// The mean area of a row of elements at each sampling instant.
std::vector<double> row_areas(const RunResults& run, int row) {
  const CsvTable table = run.csv("element_areas.csv");
  std::vector<double> means(table.rows.size(), 0.0);
  for (int column = 0; column < elements; ++column) {
    const auto areas = table.numbers(fmt::format("A{}", row * elements + column));
    for (std::size_t n = 0; n < means.size(); ++n) means[n] += areas[n] / elements;
  }
  return means;
}

Series histogram(std::span<const double> values, std::string name) {
  constexpr double first = 0.3, width = 0.025;
  constexpr std::size_t bins = 32;
  Series bars{.name = std::move(name), .mark = Mark::bars};
  for (std::size_t n = 0; n < bins; ++n) bars.x.push_back(first + (double(n) + 0.5) * width);
  bars.y.assign(bins, 0.0);
  for (const double value : values) {
    const auto bin = static_cast<std::ptrdiff_t>((value - first) / width);
    if (bin >= 0 && bin < static_cast<std::ptrdiff_t>(bins))
      bars.y[static_cast<std::size_t>(bin)] += 100.0 / static_cast<double>(values.size());
  }
  return bars;
}

struct Rows {
  std::vector<double> centre, lower;
};

Rows rows_of(const RunResults& run) { return {row_areas(run, elements / 2), row_areas(run, 0)}; }

Plot histograms(const Rows& rows, std::string title) {
  return {.title = std::move(title),
          .x = {"mean area of a row / area at rest", "", 0.3, 1.1},
          .y = {"samples", "%"},
          .series = {histogram(rows.centre, "centre row"), histogram(rows.lower, "lower row")}};
}

Comparison histogram_row(std::string what, std::span<const double> areas, std::span<const double> other,
                         const std::string& found) {
  const auto ours = solver::mean_sd(areas);
  return {.what = std::move(what),
          .paper = "histogram; another program " + found,
          .ours = text_of(ours, 3),
          .samples = count_text(ours),
          .why = fmt::format("with b = {} in place of 0.1: {}", other_b, text_of(solver::mean_sd(other), 3))};
}

// Stimuli every `period` from `from` on, as the probes see them: how many are followed by one wave.
struct Answers {
  std::size_t one_wave = 0, all = 0;
};
Answers answers(const RunResults& run, double from, double period) {
  Answers counted;
  for (const double p : all_periods(periods_of(run, from))) {
    counted.all += static_cast<std::size_t>(std::max(1.0, std::round(p / period)));
    if (std::abs(p - period) < 0.1 * period) ++counted.one_wave;
  }
  return counted;
}

double peak_to_peak(const RunResults& run) {
  const auto area = run.csv("area.csv").numbers("area");
  const auto [low, high] = std::ranges::minmax(area);
  return high - low;
}

Series area_curve(const RunResults& run, std::string name) {
  constexpr double shown = 200;  // t.u.
  const CsvTable table = run.csv("area.csv");
  auto t = table.numbers("t"), area = table.numbers("area");
  const auto count = static_cast<std::size_t>(std::ranges::upper_bound(t, areas_from + shown) - t.begin());
  t.resize(count);
  area.resize(count);
  return {.name = std::move(name), .x = in_seconds(t), .y = area};
}

}  // namespace

std::vector<Job> radial_wave_jobs(Extent) {
  SceneText scene = radial();
  show_frames(scene, radial_spacing);
  return {{"radial_frames", scene.text(), {}}};
}

MadeFigure make_radial_wave(const Runs& runs, Extent) {
  const RunResults run = runs["radial_frames"];
  const Answers seen = answers(run, 600, 31);
  return {
      .caption =
          "A stimulus in the middle every 310 ms, dark where V > 0.6, frames 90 ms apart from 15 s on; "
          "elements of 10 x 10 grid cells.",
      .figure = {.columns = frames, .panels = frame_panels(run, radial_spacing)},
      .rows = {{.what = "stimuli from 6 s on that one wave follows, at four probes",
                .paper = "all",
                .ours = fmt::format("{} of {}", seen.one_wave, seen.all),
                .difference = verdict(seen.one_wave == seen.all),
                .samples = "900 t.u.",
                .why = "at 310 ms the medium answers each stimulus, or every second one when it starts from "
                       "rest; the period is stepped down from 400 ms"}}};
}

std::vector<Job> spiral_wave_jobs(Extent) {
  SceneText central = spiral(), fed_back = spiral();
  for (SceneText* scene : {&central, &fed_back}) show_frames(*scene, spiral_spacing);
  central.set("feedback.metric", "\"none\"");
  fed_back.set("grid.n", "121");
  return {{"spiral_frames_feedback", fed_back.text(), {}}, {"spiral_frames_central", central.text(), {}}};
}

MadeFigure make_spiral_wave(const Runs& runs, Extent) {
  const RunResults central = runs["spiral_frames_central"], fed_back = runs["spiral_frames_feedback"];
  std::vector<Panel> panels = frame_panels(central, spiral_spacing);
  for (auto& panel : frame_panels(fed_back, spiral_spacing)) panels.push_back(std::move(panel));
  // Nodes between the core, in the rotation before the first frame, and the middle of the sheet.
  const auto off_middle = [](const RunResults& run) {
    const Point core = mean_tip(run, first_frame - rotation_tu);
    const double middle = 0.5 * (run.frame(0).shape.rows - 1);
    return std::hypot(core.x / shipped_dx - middle, core.y / shipped_dx - middle);
  };
  const double without = off_middle(central), with = off_middle(fed_back);
  return {
      .caption =
          "A spiral at mu1 = 0.12, frames 45 ms apart from 15 s on. Above: 71 x 71 nodes without "
          "feedback, where it stays in the middle; below: 121 x 121 with all of Eq 22.",
      .figure = {.columns = frames, .panels = std::move(panels)},
      .rows = {
          {.what = "nodes between core and middle at 15 s: 71 x 71 without feedback, 121 x 121 with it",
           .paper = "centrally located",
           .ours = fmt::format("{:.1f} and {:.1f}", without, with),
           .difference = verdict(without < 2),
           .samples = "1 rotation",
           .why = "with feedback the core drifts (Fig 7); the paper does not state the size of its sheet"}}};
}

std::vector<Job> area_histogram_jobs(Extent) {
  return {area_job({.wave = Wave::radial}), area_job({.wave = Wave::spiral}),
          area_job({.wave = Wave::radial, .b = other_b}), area_job({.wave = Wave::spiral, .b = other_b})};
}

MadeFigure make_area_histograms(const Runs& runs, Extent) {
  const auto rows = [&](const AreaRun& run) { return rows_of(runs[run.name()]); };
  const Rows radial = rows({.wave = Wave::radial}), spiral = rows({.wave = Wave::spiral}),
             radial_other = rows({.wave = Wave::radial, .b = other_b}),
             spiral_other = rows({.wave = Wave::spiral, .b = other_b});
  MadeFigure made{
      .caption =
          "Mean area of the 7 elements of the centre row and of the lower row, every 6 ms from 10 to 15 s, "
          "71 x 71 nodes, feedback on conduction switched off.",
      .figure = {.columns = 2, .panels = {histograms(radial, "Radial waves"), histograms(spiral, "Spiral")}},
      .rows = {histogram_row("radial, centre row", radial.centre, radial_other.centre, "0.704 +- 0.140"),
               histogram_row("radial, lower row", radial.lower, radial_other.lower, "0.720 +- 0.165"),
               histogram_row("spiral, centre row", spiral.centre, spiral_other.centre, "0.735 +- 0.010"),
               histogram_row("spiral, lower row", spiral.lower, spiral_other.lower, "0.731 +- 0.133")}};
  const auto spread = [](const Rows& of) {
    return solver::mean_sd(of.lower).sd / solver::mean_sd(of.centre).sd;
  };
  made.rows.push_back({.what = "spread of the lower row over that of the centre row: radial, spiral",
                       .paper = "similar; much wider",
                       .ours = fmt::format("{:.2f}; {:.1f}", spread(radial), spread(spiral)),
                       .difference = verdict(spread(radial) < 1.5 && spread(spiral) > 3),
                       .samples = fmt::format("n = {}", radial.centre.size())});
  return made;
}

namespace {

// What moves the numbers of Fig 6a to those of another program: b, the size of the stimulus, a node more.
constexpr AreaRun wide_stimulus{.wave = Wave::radial, .b = other_b, .radius = 6};
constexpr AreaRun node_off{.wave = Wave::spiral, .more = {1, 0}, .b = other_b};
constexpr AreaRun other_node_off{.wave = Wave::spiral, .more = {0, 1}, .b = other_b};

Comparison total_area_row(const Runs& runs, int offset, std::string why) {
  const double r = peak_to_peak(runs[AreaRun{.wave = Wave::radial, .offset = offset}.name()]),
               s = peak_to_peak(runs[AreaRun{.wave = Wave::spiral, .offset = offset}.name()]);
  const bool central = offset == 0;
  return {.what = fmt::format("peak to peak of the area, radial and spiral, {}",
                              central ? "in the middle" : "8 nodes down and left"),
          .paper = central ? "an order of magnitude apart; another program 0.381 and 0.015"
                           : "comparable; another program 0.308 and 0.123",
          .ours = fmt::format("{:.3f} and {:.3f}, {:.1f} times", r, s, r / s),
          .difference = verdict(central ? r / s > 10 : r / s < 5),
          .samples = "10 to 15 s",
          .why = std::move(why)};
}

}  // namespace

std::vector<Job> total_area_jobs(Extent) {
  std::vector<Job> jobs;
  for (const int offset : {0, off})
    for (const Wave wave : {Wave::radial, Wave::spiral})
      jobs.push_back(area_job({.wave = wave, .offset = offset}));
  for (const AreaRun& run : {wide_stimulus, node_off, other_node_off}) jobs.push_back(area_job(run));
  return jobs;
}

MadeFigure make_total_area(const Runs& runs, Extent) {
  MadeFigure made{.caption =
                      "Area of the whole sheet over that at rest, feedback switched off: radial waves (R) "
                      "and a spiral (S), both in the middle or both 8 nodes down and left of it.",
                  .figure = {.columns = 2}};
  for (const int offset : {0, off})
    made.figure.panels.push_back(
        Plot{.title = offset == 0 ? "In the middle" : "8 nodes down and left",
             .x = {"time", "s"},
             .y = {"area / area at rest", ""},
             .series = {area_curve(runs[AreaRun{.wave = Wave::radial, .offset = offset}.name()], "R"),
                        area_curve(runs[AreaRun{.wave = Wave::spiral, .offset = offset}.name()], "S")}});
  made.rows = {
      total_area_row(
          runs, 0,
          fmt::format("with b = {} and a stimulus of radius 6: {:.3f}; a core one node to the right or up "
                      "of ours: {:.3f}, {:.3f}",
                      other_b, peak_to_peak(runs[wide_stimulus.name()]), peak_to_peak(runs[node_off.name()]),
                      peak_to_peak(runs[other_node_off.name()]))),
      total_area_row(runs, off, "")};
  return made;
}

}  // namespace myowave::apps
