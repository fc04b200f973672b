#include "solver/analysis/tip_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace myowave::solver {
namespace {

auto place(const Tip& tip) { return std::pair{tip.y, tip.x}; }

double distance(const Tip& a, const Tip& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// Two of a list each, or one of them twice, and what it costs to take them together.
struct Candidate {
  double cost;
  std::size_t first, second;
  bool operator<(const Candidate& other) const {
    return std::tie(cost, first, second) < std::tie(other.cost, other.first, other.second);
  }
};

// Those of `tips`, which are sorted by place, whose row is at most `reach` from that of `tip`.
std::pair<std::size_t, std::size_t> in_reach(const std::vector<Tip>& tips, const Tip& tip, double reach) {
  const auto first = std::ranges::lower_bound(tips, tip.y - reach, {}, &Tip::y);
  const auto last = std::ranges::upper_bound(tips, tip.y + reach, {}, &Tip::y);
  return {first - tips.begin(), last - tips.begin()};
}

constexpr std::size_t none = -1;

// Of each old tip the new one that it has become.
std::vector<std::size_t> link(const std::vector<Tip>& old, const std::vector<Tip>& fresh, double reach) {
  std::vector<Candidate> candidates;
  for (std::size_t a = 0; a < old.size(); ++a) {
    const auto [first, last] = in_reach(fresh, old[a], reach);
    for (std::size_t b = first; b < last; ++b)
      if (const double d = distance(old[a], fresh[b]); d <= reach && old[a].charge == fresh[b].charge)
        candidates.push_back({d, a, b});
  }
  std::ranges::sort(candidates, std::less<>());
  std::vector<std::size_t> becomes(old.size(), none);
  std::vector<bool> taken(fresh.size());
  for (const auto& [cost, a, b] : candidates)
    if (becomes[a] == none && !taken[b]) {
      becomes[a] = b;
      taken[b] = true;
    }
  return becomes;
}

}  // namespace

void RotationMeter::add(double t, double x, double y) {
  const Point point{t, x, y};
  points_.push_back(point);
  if (!corner_)
    corner_ = point;
  else if (std::hypot(x - corner_->x, y - corner_->y) >= step_)
    turn(point);
}

void RotationMeter::turn(const Point& point) {
  const double heading = std::atan2(point.y - corner_->y, point.x - corner_->x);
  const double time = 0.5 * (corner_->t + point.t);
  if (heading_) {
    const double before = turned_;
    turned_ += std::remainder(heading - *heading_, full_turn);
    if (std::abs(turned_) >= full_turn) {
      const double part = (full_turn - std::abs(before)) / (std::abs(turned_) - std::abs(before));
      end_rotation(heading_time_ + part * (time - heading_time_));
      turned_ -= std::copysign(full_turn, turned_);
    }
  } else {  // the first rotation begins here
    std::erase_if(points_, [&](const Point& p) { return p.t < time; });
  }
  heading_ = heading;
  heading_time_ = time;
  corner_ = point;
}

void RotationMeter::end_rotation(double t) {
  const auto end = std::ranges::find_if(points_, [&](const Point& p) { return p.t >= t; });
  const auto n = static_cast<double>(end - points_.begin());
  if (n == 0) return;
  Point mean{0, 0, 0};
  for (auto p = points_.begin(); p != end; ++p) mean = {mean.t + p->t, mean.x + p->x, mean.y + p->y};
  sums_.x += mean.x;
  sums_.y += mean.y;
  mean = {mean.t / n, mean.x / n, mean.y / n};
  for (auto p = points_.begin(); p != end; ++p) sums_.radius += std::hypot(p->x - mean.x, p->y - mean.y);
  ++sums_.rotations;
  points_in_rotations_ += end - points_.begin();
  points_.erase(points_.begin(), end);

  if (!first_) first_ = mean;
  const double time = mean.t - first_->t, x = mean.x - first_->x, y = mean.y - first_->y;
  sum_t_ += time;
  sum_tt_ += time * time;
  sum_x_ += x;
  sum_y_ += y;
  sum_tx_ += time * x;
  sum_ty_ += time * y;
}

std::optional<TipCore> RotationMeter::core() const {
  if (sums_.rotations == 0) return std::nullopt;
  const auto n = static_cast<double>(points_in_rotations_);
  return TipCore{sums_.x / n, sums_.y / n, sums_.radius / n, sums_.rotations};
}

std::optional<TipDrift> RotationMeter::drift() const {
  if (sums_.rotations < 2) return std::nullopt;
  const auto n = static_cast<double>(sums_.rotations);
  const double variance = n * sum_tt_ - sum_t_ * sum_t_;
  const double vx = (n * sum_tx_ - sum_t_ * sum_x_) / variance;
  const double vy = (n * sum_ty_ - sum_t_ * sum_y_) / variance;
  return TipDrift{std::hypot(vx, vy), std::atan2(vy, vx)};
}

double gating_distance(const Scene& scene, double interval) {
  const auto& e = scene.excitation;
  const double speed = std::sqrt(0.5 * e.k * e.D) / e.C_m;
  const double front = e.k > 0 ? std::sqrt(8 * e.D / e.k) : 0;
  return 2 * speed * interval + std::max(2.5 * front, 4 * scene.grid.dx);
}

TipTrajectories::TipTrajectories(const Scene& scene) : scene_(scene) {}

double TipTrajectories::to_edge(const Tip& tip) const {
  const auto& grid = scene_.grid;
  return std::min({tip.x, tip.y, grid.dx * (grid.columns - 1) - tip.x, grid.dx * (grid.rows - 1) - tip.y});
}

// Tips that came or went in the same instant, sorted by place.
std::vector<TipEvent> TipTrajectories::explain(const std::vector<Tip>& tips, double reach) const {
  std::vector<Candidate> candidates;
  for (std::size_t a = 0; a < tips.size(); ++a) {
    if (const double d = to_edge(tips[a]); d <= reach) candidates.push_back({d, a, a});
    const auto [first, last] = in_reach(tips, tips[a], 2 * reach);
    for (std::size_t b = std::max(first, a + 1); b < last; ++b)
      if (const double d = distance(tips[a], tips[b]); d <= 2 * reach && tips[a].charge == -tips[b].charge)
        candidates.push_back({d / 2, a, b});  // each has half of the way
  }
  std::ranges::sort(candidates, std::less<>());
  std::vector<TipEvent> events(tips.size(), TipEvent::alone);
  for (const auto& [cost, a, b] : candidates)
    if (events[a] == TipEvent::alone && events[b] == TipEvent::alone)
      events[a] = events[b] = a == b ? TipEvent::boundary : TipEvent::pair;
  return events;
}

void TipTrajectories::add_sample(double t, std::span<Tip> tips) {
  const double reach = gating_distance(scene_, last_sample_ ? t - *last_sample_ : 0);
  std::vector<Tip*> sorted;
  for (auto& tip : tips) sorted.push_back(&tip);
  std::ranges::sort(sorted, {}, [](const Tip* tip) { return place(*tip); });
  std::vector<Tip> old, fresh;
  for (const auto& live : live_) old.push_back(live.tip);
  for (const Tip* tip : sorted) fresh.push_back(*tip);

  const auto becomes = link(old, fresh, reach);
  std::vector<std::size_t> gone;
  std::vector<Tip> gone_tips;
  std::vector<Live> next;
  std::vector<bool> known(fresh.size());
  for (std::size_t a = 0; a < old.size(); ++a) {
    if (becomes[a] == none) {
      gone.push_back(a);
      gone_tips.push_back(old[a]);
    } else {
      known[becomes[a]] = true;
      follow(live_[a], t, *sorted[becomes[a]]);
      next.push_back(std::move(live_[a]));
    }
  }
  const auto ends = explain(gone_tips, reach);
  for (std::size_t n = 0; n < gone.size(); ++n) end(live_[gone[n]], ends[n]);

  std::vector<Tip*> born;
  std::vector<Tip> born_tips;
  for (std::size_t b = 0; b < fresh.size(); ++b)
    if (!known[b]) {
      born.push_back(sorted[b]);
      born_tips.push_back(fresh[b]);
    }
  const auto births = explain(born_tips, reach);
  for (std::size_t n = 0; n < born.size(); ++n) {
    Live live = new_live();
    live.trajectory.number = next_number_++;
    live.trajectory.charge = born[n]->charge;
    live.trajectory.birth = t;
    live.trajectory.born = last_sample_ ? births[n] : TipEvent::run;
    ++counts_.n;
    ++counts_.born[static_cast<std::size_t>(live.trajectory.born)];
    follow(live, t, *born[n]);
    next.push_back(std::move(live));
  }
  std::ranges::sort(next, {}, [](const Live& live) { return place(live.tip); });
  live_ = std::move(next);
  last_sample_ = t;
}

void TipTrajectories::follow(Live& live, double t, Tip& tip) {
  TipTrajectory& trajectory = live.trajectory;
  tip.trajectory = trajectory.number;
  live.tip = tip;
  trajectory.death = t;
  if (!trajectory.boundary && to_edge(tip) <= boundary_nodes * scene_.grid.dx) trajectory.boundary = t;
  live.rotations.add(t, tip.x, tip.y);
}

void TipTrajectories::end(const Live& live, TipEvent event) {
  TipTrajectory ended = live.trajectory;
  ended.ended = event;
  ended.core = live.rotations.core();
  ended.drift = live.rotations.drift();
  ++counts_.ended[static_cast<std::size_t>(event)];
  const auto life = [](const TipTrajectory& t) { return std::pair{t.death - t.birth, -t.number}; };
  if (!longest_ || life(ended) > life(*longest_)) longest_ = ended;
  ended_.push_back(ended);
}

void TipTrajectories::finish() {
  std::ranges::sort(live_, {}, [](const Live& live) { return live.trajectory.number; });
  for (const auto& live : live_) end(live, TipEvent::run);
  live_.clear();
}

std::vector<TipTrajectory> TipTrajectories::take_ended() { return std::exchange(ended_, {}); }

}  // namespace myowave::solver
