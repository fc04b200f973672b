#include "solver/excitation/stimulus_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace myowave::solver {
namespace {

tissue::StimulusRegion make_region(const Stimulus& s, const GridSettings& grid) {
  switch (s.shape) {
    case Stimulus::Shape::block:
      return {s.rows[0], s.rows[1] + 1, s.columns[0], s.columns[1] + 1};
    case Stimulus::Shape::disc: {
      // Both inside 0 ... n also where the disc is off the sheet: an empty box.
      const auto first = [&](double center, double n) {
        return static_cast<int>(std::clamp(std::ceil(center - s.radius), 0.0, n));
      };
      const auto end = [&](double center, double n) {
        return static_cast<int>(std::clamp(std::floor(center + s.radius) + 1, 0.0, n));
      };
      return {first(s.center[1], grid.rows),
              end(s.center[1], grid.rows),
              first(s.center[0], grid.columns),
              end(s.center[0], grid.columns),
              s.center[1],
              s.center[0],
              s.radius * s.radius};
    }
    case Stimulus::Shape::all:
      break;
  }
  return {0, grid.rows, 0, grid.columns};
}

double last_end(const Stimulus& s) {
  if (s.count < 0) return std::numeric_limits<double>::infinity();
  return s.start + (static_cast<double>(s.count) - 1) * s.period + s.duration;
}

}  // namespace

StimulusSchedule::StimulusSchedule(const std::vector<Stimulus>& stimuli, const GridSettings& grid, double dt)
    : stimuli_(stimuli), tolerance_(1e-6 * dt) {
  for (const auto& s : stimuli_) regions_.push_back(make_region(s, grid));
  active_.reserve(stimuli_.size());
}

const std::vector<tissue::ActiveStimulus>& StimulusSchedule::active(double t) {
  active_.clear();
  for (std::size_t n = 0; n < stimuli_.size(); ++n) {
    const auto& s = stimuli_[n];
    if (t < s.start - tolerance_) continue;
    double pulse = s.period > 0 ? std::floor((t - s.start + tolerance_) / s.period) : 0;
    if (s.count >= 0) pulse = std::min(pulse, static_cast<double>(s.count) - 1);
    if (pulse >= 0 && t < s.start + pulse * s.period + s.duration - tolerance_)
      active_.push_back({regions_[n], s.amplitude});
  }
  return active_;
}

bool StimulusSchedule::more_to_come(double t) const {
  return std::any_of(stimuli_.begin(), stimuli_.end(),
                     [&](const Stimulus& s) { return s.amplitude != 0 && s.count != 0 && t < last_end(s); });
}

double StimulusSchedule::last_period() const {
  double period = 0, end = -1;
  for (const auto& s : stimuli_)
    if (s.period > 0 && last_end(s) > end) {
      end = last_end(s);
      period = s.period;
    }
  return period;
}

}  // namespace myowave::solver
