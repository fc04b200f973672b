#include "solver/run/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "solver/base/activation_maps.hpp"

namespace myowave::solver {
namespace {

std::int64_t steps_of(double duration, const Scene& scene) { return std::llround(duration / scene.time.dt); }

std::int64_t every(double interval, const Scene& scene) {
  return std::max<std::int64_t>(1, steps_of(interval, scene));
}

}  // namespace

Schedule::Schedule(const Scene& scene)
    : last(steps_of(scene.time.t_end, scene)),
      fields(every(scene.output.every, scene)),
      tips(every(scene.output.tips_every, scene)),
      probes(every(scene.output.probes_every, scene)),
      watch(every(scene.output.watch_every, scene)),
      maps(scene.output.maps ? every(ActivationMaps::sample_every, scene) : watch),
      mechanics(scene.mechanics ? scene.mechanics->interval : 0),
      check(scene.mechanics ? scene.mechanics->interval : check_without_mechanics),
      // A decimal number of t.u. is only close to the step that is meant.
      fields_from(scene.output.from / scene.time.dt - 1e-6) {}

std::int64_t Schedule::next(std::int64_t step) const {
  std::int64_t next = last;
  for (const auto period : {fields, tips, probes, watch, maps, check})
    next = std::min(next, (step / period + 1) * period);
  return next;
}

}  // namespace myowave::solver
