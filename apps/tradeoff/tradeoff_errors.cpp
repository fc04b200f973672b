#include "apps/tradeoff/tradeoff_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/results/observable_table.hpp"
#include "solver/analysis/error_norms.hpp"
#include "solver/analysis/richardson.hpp"
#include "solver/analysis/statistics.hpp"

namespace myowave::apps {
namespace {

using Kind = Observable::Kind;
using Chaos = Observable::Chaos;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

Observable observable_of(const ObservableRow& row) {
  using enum ObservableError::Kind;
  const auto& [name, title, kind, chaos] = row.error;
  return {name, title, kind == relative ? "%" : row.unit.text,
          kind == relative   ? Kind::relative
          : kind == absolute ? Kind::absolute
                             : Kind::event,
          chaos == ObservableError::Chaos::left_out    ? Chaos::left_out
          : chaos == ObservableError::Chaos::statistic ? Chaos::statistic
                                                       : Chaos::statistic_only};
}

// Means of every scene, single trajectories, events, means of chaotic scenes.
enum class Group { statistic, path, event, statistic_only };

Group group_of(const Observable& one) {
  if (one.kind == Kind::event) return Group::event;
  if (one.chaos == Chaos::left_out) return Group::path;
  return one.chaos == Chaos::statistic ? Group::statistic : Group::statistic_only;
}

std::vector<Observable> make_observables() {
  std::vector<Observable> all{{"cv", "speed of a plane wave", "%", Kind::relative, Chaos::same},
                              {"apd", "duration of an action potential", "%", Kind::relative, Chaos::same}};
  const auto add = [&all](Group group) {
    for (const ObservableRow& row : observable_table())
      if (row.error.kind != ObservableError::Kind::none && group_of(observable_of(row)) == group)
        all.push_back(observable_of(row));
  };
  add(Group::statistic);
  all.insert(all.end(),
             {{"area", "area over time", "%", Kind::curve, Chaos::left_out},
              {"field_half", "V at half of the time", "%", Kind::field_half, Chaos::left_out},
              {"field_end", "V at the end", "%", Kind::field_end, Chaos::left_out},
              {"tip", "place of the tips at the end", "length units", Kind::tips, Chaos::left_out}});
  add(Group::path);
  add(Group::event);
  add(Group::statistic_only);
  all.push_back({"area_mean", "mean area", "%", Kind::relative, Chaos::statistic_only});
  return all;
}

bool is_number(const Observable& one) {
  return one.kind == Kind::relative || one.kind == Kind::absolute || one.kind == Kind::event;
}

bool is_statistic(const Observable& one) {
  return one.chaos == Chaos::statistic || one.chaos == Chaos::statistic_only;
}

bool is_compared(const Observable& one, bool chaotic) {
  return one.chaos != (chaotic ? Chaos::left_out : Chaos::statistic_only);
}

std::optional<double> number_in(const Measures& measures, std::string_view name) {
  const auto found = measures.numbers.find(name);
  return found == measures.numbers.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> percent_of(double difference, double of) {
  return of == 0 ? std::nullopt : std::optional(100 * std::abs(difference / of));
}

std::optional<double> percent(std::optional<double> ratio) {
  return ratio ? std::optional(100 * *ratio) : std::nullopt;
}

// The small V that remains on a quiescent sheet is not a wave.
std::optional<double> field_error(std::span<const double> a, std::span<const double> b) {
  constexpr double at_rest = 1e-3;
  return solver::rms(b) < at_rest ? std::nullopt : percent(solver::relative_l2(a, b));
}

std::optional<double> curve_error(const Measures::Curve& a, const Measures::Curve& b) {
  if (b.t.size() < 2) return std::nullopt;
  std::vector<double> seen, expected;
  for (std::size_t n = 0; n < a.t.size(); ++n) {
    if (a.t[n] > b.t.back()) break;
    seen.push_back(a.value[n] - 1);
    expected.push_back(solver::interpolate_cubic(b.t, b.value, a.t[n]) - 1);
  }
  return percent(solver::relative_l2(seen, expected));
}

// In the unit of the error.
double in_unit(const Observable& one, double difference, double value) {
  return one.kind == Kind::relative ? percent_of(difference, value).value_or(unknown) : std::abs(difference);
}

std::vector<double> spacings(std::span<const int> k) {
  std::vector<double> h;
  for (const int one : k) h.push_back(1.0 / one);
  return h;
}

ReferenceValue limit_of(const Observable& one, std::span<const int> k, std::span<const double> values) {
  const auto limit = solver::richardson(spacings(k), values);
  return {{values.begin(), values.end()},
          limit.value,
          in_unit(one, limit.uncertainty, limit.value),
          limit.order,
          limit.order ? "extrapolated from three grids" : "the finest grid"};
}

// Of the runs that have it.
solver::MeanSd over_runs(std::span<const Measures> runs, std::string_view name) {
  solver::RunningStatistics statistics;
  for (const auto& run : runs)
    if (const auto value = number_in(run, name)) statistics.add(*value);
  return statistics.result();
}

double standard_error(const solver::MeanSd& of) {
  return of.n > 1 ? of.sd / std::sqrt(static_cast<double>(of.n)) : unknown;
}

std::optional<ReferenceValue> mean_over_starts(const Observable& one, std::span<const double> levels,
                                               std::span<const Measures> starts) {
  const auto seen = over_runs(starts, one.name);
  if (seen.n == 0) return std::nullopt;
  return ReferenceValue{
      {levels.begin(), levels.end()},
      seen.mean,
      in_unit(one, standard_error(seen), seen.mean),
      std::nullopt,
      fmt::format("mean of {} of {} starts; the uncertainty is its standard error", seen.n, starts.size())};
}

// Of curves, fields and tips, which have no value of their own.
std::optional<ReferenceValue> finest_of(const Observable& one, std::span<const int> k,
                                        std::span<const Measures> levels) {
  if (!error_of(one, levels.back(), levels.back())) return std::nullopt;
  ReferenceValue reference{{}, std::nullopt, unknown, std::nullopt, "the finest grid"};
  for (std::size_t n = 1; n < levels.size(); ++n)
    reference.levels.push_back(error_of(one, levels[n - 1], levels[n]).value_or(unknown));
  const auto& distances = reference.levels;
  if (!distances.empty()) reference.uncertainty = distances.back();
  if (distances.size() == 2) {
    const auto h = spacings(k);
    reference.order = solver::observed_order({h[0], h[1], h[2]}, distances[0], distances[1]);
  }
  return reference;
}

}  // namespace

std::span<const Observable> observables() {
  static const std::vector<Observable> all = make_observables();
  return all;
}

const Observable* find_observable(std::string_view name) {
  const auto found = std::ranges::find(observables(), name, &Observable::name);
  return found == observables().end() ? nullptr : &*found;
}

std::optional<double> error_of(const Observable& one, const Measures& a, const Measures& b) {
  switch (one.kind) {
    case Kind::curve:
      return curve_error(a.area, b.area);
    case Kind::field_half:
      return field_error(a.V_half, b.V_half);
    case Kind::field_end:
      return field_error(a.V_end, b.V_end);
    case Kind::tips:
      return solver::tip_distance(a.tips, b.tips);
    case Kind::relative:
    case Kind::absolute:
    case Kind::event:
      break;
  }
  const auto seen = number_in(a, one.name), expected = number_in(b, one.name);
  if (one.kind == Kind::event && seen.has_value() != expected.has_value()) return infinite;
  if (!seen || !expected) return std::nullopt;
  return one.kind == Kind::relative ? percent_of(*seen - *expected, *expected) : std::abs(*seen - *expected);
}

bool is_chaotic(std::span<const Measures> levels) {
  if (levels.size() < 2) return false;
  const auto difference =
      error_of(*find_observable("field_end"), levels[levels.size() - 2], levels[levels.size() - 1]);
  return difference.value_or(0) > chaotic_difference;
}

Reference make_reference(std::vector<int> k, std::span<const Measures> levels,
                         std::span<const Measures> starts) {
  Reference reference{std::move(k), is_chaotic(levels), levels.back(), {}};
  reference.best.numbers.clear();
  for (const Observable& one : observables()) {
    if (!is_compared(one, reference.chaotic)) continue;
    std::optional<ReferenceValue> value;
    if (!is_number(one)) {
      value = finest_of(one, reference.levels, levels);
    } else {
      std::vector<double> numbers;
      for (const auto& level : levels)
        if (const auto number = number_in(level, one.name)) numbers.push_back(*number);
      if (reference.chaotic && is_statistic(one))
        value = mean_over_starts(one, numbers, starts);
      else if (numbers.size() == levels.size())
        value = limit_of(one, reference.levels, numbers);
      if (!value && one.kind == Kind::event && numbers.empty())
        value = ReferenceValue{{}, std::nullopt, unknown, std::nullopt, "does not occur"};
    }
    if (!value) continue;
    if (value->value) reference.best.numbers[std::string(one.name)] = *value->value;
    reference.values.emplace(one.name, std::move(*value));
  }
  return reference;
}

Errors errors_of(std::span<const Measures> runs, const Reference& reference) {
  Errors errors;
  for (const auto& [name, value] : reference.values) {
    const Observable& one = *find_observable(name);
    Error error{.uncertainty = value.uncertainty};
    std::optional<double> seen;
    if (reference.chaotic && is_statistic(one)) {
      const auto over = over_runs(runs, name);
      Measures mean;
      if (over.n > 0) mean.numbers[name] = over.mean;
      seen = error_of(one, mean, reference.best);
      error.uncertainty =
          std::hypot(value.uncertainty, in_unit(one, standard_error(over), value.value.value_or(over.mean)));
    } else {
      seen = error_of(one, runs.front(), reference.best);
    }
    if (!seen) continue;
    error.value = *seen;
    errors[name] = error;
  }
  return errors;
}

std::vector<bool> pareto_front(std::span<const double> cost, std::span<const double> error) {
  std::vector<bool> front(cost.size());
  for (std::size_t n = 0; n < cost.size(); ++n) {
    bool beaten = !std::isfinite(cost[n]) || !std::isfinite(error[n]);
    for (std::size_t m = 0; m < cost.size() && !beaten; ++m)
      beaten = cost[m] <= cost[n] && error[m] <= error[n] && (cost[m] < cost[n] || error[m] < error[n]);
    front[n] = !beaten;
  }
  return front;
}

namespace {

// Largest ratio of an error to its target; infinite where the candidate lacks one.
double miss_of(const Candidate& candidate, std::span<const ErrorTarget> targets) {
  double largest = 0;
  for (const auto& target : targets) {
    const auto found = candidate.errors.find(target.observable);
    if (found == candidate.errors.end()) return infinite;
    largest = std::max(largest, found->second.value / target.largest);
  }
  return largest;
}

}  // namespace

std::optional<std::size_t> choose(std::span<const Candidate> candidates,
                                  std::span<const ErrorTarget> targets) {
  std::optional<std::size_t> best;
  for (std::size_t n = 0; n < candidates.size(); ++n)
    if (miss_of(candidates[n], targets) <= 1 && (!best || candidates[n].cost < candidates[*best].cost))
      best = n;
  return best;
}

std::optional<std::size_t> nearest_to(std::span<const Candidate> candidates,
                                      std::span<const ErrorTarget> targets) {
  std::optional<std::size_t> best;
  double least = infinite;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    const double miss = miss_of(candidates[n], targets);
    if (miss < least) least = miss, best = n;
  }
  return best;
}

}  // namespace myowave::apps
