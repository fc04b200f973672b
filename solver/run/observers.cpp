#include "solver/run/observers.hpp"

#include <algorithm>

namespace myowave::solver {

Observers::Observers(const Scene& scene)
    : scene_(scene),
      beats_(scene.output.probes.size(), scene.output.period_from),
      settled_(scene.initial.type == InitialSettings::Type::broken_front &&
                       scene.initial.preconditions.empty()
                   ? BreakupWatch::settling_time
                   : 0),
      breakup_(settled_),
      trajectories_(scene) {}

void Observers::link(double t, std::span<Tip> tips) {
  if (t >= settled_) trajectories_.add_sample(t, tips);
}

bool Observers::wants_end() const {
  const StopOn& on = scene_.time.stop_on;
  return (on.breakup && breakup_.breakup()) || (on.death && breakup_.death());
}

void Observers::add_probe_history(std::int64_t first, std::span<const double> history) {
  const std::size_t probes = scene_.output.probes.size();
  if (probes == 0) return;
  for (std::size_t n = 0; n * probes < history.size(); ++n)
    beats_.add(static_cast<double>(first + static_cast<std::int64_t>(n)) * scene_.time.dt,
               history.subspan(n * probes, probes));
}

void Observers::write(Observables& o, double t, double stimulus_period) const {
  o.period = beats_.period();
  o.apd = beats_.apd();
  o.apd90 = beats_.apd90();
  o.tips = series_statistics(tip_counts_);
  if (o.tips.correlation) o.tips_correlation_tu = *o.tips.correlation * scene_.output.tips_every;
  o.trajectories = trajectories_.counts();
  o.longest_trajectory = trajectories_.longest();
  o.breakup_tu = breakup_.breakup();
  o.death_tu = breakup_.death();
  if (areas_.empty()) return;
  o.area = {areas_[0].ratio, areas_[0].ratio};
  for (const auto& a : areas_) o.area = {std::min(o.area->first, a.ratio), std::max(o.area->second, a.ratio)};
  constexpr double last_periods = 10;
  const double from = stimulus_period > 0 ? t - last_periods * stimulus_period : 0;
  o.shortening.reset();
  for (const auto& a : areas_)
    if (a.t >= from && (!o.shortening || a.shortening > o.shortening->first))
      o.shortening = {a.shortening, a.t};
}

}  // namespace myowave::solver
