#include "solver/analysis/cell_protocol.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "solver/base/error.hpp"
#include "solver/excitation/select_model.hpp"

namespace myowave::solver {
namespace {

std::int64_t steps_of(double length, double dt, const char* what) {
  const std::int64_t steps = std::llround(length / dt);
  if (steps < 1) throw InputError(fmt::format("{} = {} t.u. is shorter than a step of {}", what, length, dt));
  return steps;
}

// The cell in time; stimuli are given to it.
class Cell {
 public:
  explicit Cell(const PacedCell& cell, const CellState& state = {})
      : cell_(cell), model_(make_model<double>(cell.excitation, cell.tension)), state_(state) {}

  void step(double stimulus) {
    const auto [V, r, Ta] = state_;
    state_.V += cell_.dt * (model_.cell.excitation(V, r) + stimulus) * model_.inverse_C_m;
    state_.r += cell_.dt * model_.cell.recovery(V, r);
    if (cell_.tension.law != TensionLaw::none) state_.Ta += cell_.dt * model_.tension.rate(V, Ta);
    ++steps_;
  }

  double t() const { return static_cast<double>(steps_) * cell_.dt; }
  std::int64_t steps() const { return steps_; }
  const CellState& state() const { return state_; }

 private:
  PacedCell cell_;
  Model<double> model_;
  CellState state_;
  std::int64_t steps_ = 0;
};

// Pulses at a cycle length, of a cell that is somewhere in its course.
class Pacing {
 public:
  Pacing(const PacedCell& cell, double cycle_length)
      : dt_(cell.dt),
        cycle_(steps_of(cycle_length, cell.dt, "the cycle length")),
        pulse_(steps_of(cell.duration, cell.dt, "the duration of a pulse")),
        amplitude_(cell.amplitude) {
    if (pulse_ > cycle_)
      throw InputError(
          fmt::format("a pulse of {} t.u. is longer than the cycle of {} t.u.", cell.duration, cycle_length));
  }

  double cycle_length() const { return static_cast<double>(cycle_) * dt_; }

  // One cycle from now; before_step() before every step.
  template <class Action>
  void cycle(Cell& cell, const Action& before_step) const {
    for (std::int64_t n = 0; n < cycle_; ++n) {
      before_step();
      cell.step(n < pulse_ ? amplitude_ : 0);
    }
  }

 private:
  double dt_;
  std::int64_t cycle_, pulse_;
  double amplitude_;
};

// Pulses at one cycle length, the first of them at t = `begin`.
struct Cycles {
  double length, begin;
  int pulses;
};

bool alternate(const std::vector<Beat>& beats, double alternans) {
  double before = 0;
  for (std::size_t n = 1; n < beats.size(); ++n) {
    const double difference = beats[n].apd - beats[n - 1].apd;
    if (!(std::abs(difference) > alternans) || before * difference > 0) return false;
    before = difference;
  }
  return beats.size() > 1;
}

RestitutionPoint point_of(const Cycles& cycles, const std::vector<Beat>& beats, double alternans) {
  RestitutionPoint point;
  point.cycle_length = cycles.length;
  std::vector<int> upstrokes(static_cast<std::size_t>(cycles.pulses));  // after each pulse
  for (const Beat& beat : beats) {
    const double pulse = std::floor((beat.upstroke - cycles.begin) / cycles.length);
    if (pulse < 0 || pulse >= cycles.pulses) continue;
    ++upstrokes[static_cast<std::size_t>(pulse)];
    point.beats.push_back(beat);
  }
  using Capture = RestitutionPoint::Capture;
  const auto each = [&](const auto& wanted) {
    for (std::size_t n = 0; n < upstrokes.size(); ++n)
      if (upstrokes[n] != wanted(n)) return false;
    return true;
  };
  if (each([](std::size_t) { return 1; })) point.capture = Capture::one_to_one;
  if (each([&](std::size_t n) { return n % 2 == 0 ? upstrokes[0] : 1 - upstrokes[0]; }))
    point.capture = Capture::two_to_one;
  point.alternates = point.capture == Capture::one_to_one && alternate(point.beats, alternans);
  return point;
}

double mean_of(const std::vector<Beat>& beats, double Beat::*value) {
  RunningStatistics statistics;
  for (const Beat& beat : beats)
    if (!std::isnan(beat.*value)) statistics.add(beat.*value);
  const MeanSd result = statistics.result();
  return result.n > 0 ? result.mean : std::nan("");
}

}  // namespace

PacedCell aliev_panfilov_cell() {
  PacedCell cell;
  cell.excitation = {{.k = 8, .a = 0.15, .b = 0.15, .eps = 0.002, .mu1 = 0.2, .mu2 = 0.3}};
  cell.dt = 0.001;
  return cell;
}

double time_to_fall(const PacedCell& settings, const CellState& state, double level) {
  constexpr double longest = 10000;  // t.u.: hundreds of action potentials
  Cell cell(settings, state);
  while (cell.t() < longest) {
    const double before = cell.state().V, t = cell.t();
    cell.step(0);
    const double after = cell.state().V;
    if (before >= level && after < level) return t + settings.dt * (before - level) / (before - after);
  }
  throw NumericalFailure(
      fmt::format("V = {} is not reached from V = {}, r = {} in {} t.u.", level, state.V, state.r, longest));
}

CellCourse pace_cell(const PacedCell& settings, double cycle_length, int pulses, double sample_every) {
  const Pacing pacing(settings, cycle_length);
  const std::int64_t sample = steps_of(sample_every, settings.dt, "the sampling interval");
  Cell cell(settings);
  BeatDetector detector;
  CellCourse course;
  const auto record = [&] {
    const CellState& state = cell.state();
    if (const auto beat = detector.add(cell.t(), state.V)) course.beats.push_back(*beat);
    if (cell.steps() % sample != 0) return;
    course.t.push_back(cell.t());
    course.V.push_back(state.V);
    course.r.push_back(state.r);
    course.Ta.push_back(state.Ta);
  };
  for (int n = 0; n < pulses; ++n) pacing.cycle(cell, record);
  record();
  if (detector.last()) course.beats.push_back(*detector.last());
  return course;
}

double RestitutionPoint::apd() const { return mean_of(beats, &Beat::apd); }
double RestitutionPoint::apd90() const { return mean_of(beats, &Beat::apd90); }
double RestitutionPoint::di() const { return mean_of(beats, &Beat::di); }

std::vector<RestitutionPoint> restitution(const RestitutionProtocol& protocol) {
  if (!(protocol.step > 0 && protocol.shortest <= protocol.longest && protocol.kept >= 2 &&
        protocol.kept <= protocol.pulses))
    throw InputError(
        "a restitution steps down by more than 0 from its longest cycle length to its shortest, and keeps "
        "from 2 to all pulses of each");
  Cell cell(protocol.cell);
  BeatDetector detector;
  std::vector<Beat> beats;
  const auto record = [&] {
    if (const auto beat = detector.add(cell.t(), cell.state().V)) beats.push_back(*beat);
  };
  std::vector<Cycles> kept;
  constexpr double rounding = 1e-9;  // of a quotient of cycle lengths
  const auto lengths =
      static_cast<int>((protocol.longest - protocol.shortest) / protocol.step + rounding) + 1;
  for (int n = 0; n < lengths; ++n) {
    const Pacing pacing(protocol.cell, protocol.longest - n * protocol.step);
    for (int pulse = 0; pulse < protocol.pulses - protocol.kept; ++pulse) pacing.cycle(cell, record);
    kept.push_back({pacing.cycle_length(), cell.t(), protocol.kept});
    for (int pulse = 0; pulse < protocol.kept; ++pulse) pacing.cycle(cell, record);
  }
  record();
  if (detector.last()) beats.push_back(*detector.last());

  std::vector<RestitutionPoint> points;
  for (const Cycles& cycles : kept) points.push_back(point_of(cycles, beats, protocol.alternans));
  return points;
}

}  // namespace myowave::solver
