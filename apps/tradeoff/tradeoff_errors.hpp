// Errors of settings against a reference, the Pareto front of cost and error, and the setting that meets a
// target.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/tradeoff/tradeoff_measure.hpp"
#include "apps/tradeoff/tradeoff_settings.hpp"

namespace myowave::apps {

struct Observable {
  // An event has a time, or does not occur.
  enum class Kind { relative, absolute, event, curve, field_half, field_end, tips };
  // What is compared of a chaotic scene: nothing of a single path, statistics against their spread.
  enum class Chaos { same, left_out, statistic, statistic_only };

  std::string_view name, title, unit;
  Kind kind;
  Chaos chaos;
};

std::span<const Observable> observables();
// Null if there is no observable of this name.
const Observable* find_observable(std::string_view name);

// Of a against b, in the observable's unit: in % of b, for curves and fields by the L2 norm, of an area curve
// of its distance from 1; or the distance; of tips the mean distance of b's to the nearest of a that turns
// the same way. Infinite of an event that one of them has alone. None where one of them lacks it, both the
// event, nor of V where b is at rest.
std::optional<double> error_of(const Observable&, const Measures& a, const Measures& b);

// Errors of an observable are against this.
struct ReferenceValue {
  std::vector<double> levels;   // coarse to fine; of curves, fields and tips the distance from the next finer
  std::optional<double> value;  // extrapolated, or the mean over starts; of numbers only, not of no event
  double uncertainty = 0;       // in the unit of the error; nan where it is not known
  std::optional<double> order{};
  std::string how;
};

struct Reference {
  std::vector<int> levels;  // those that reached their end
  bool chaotic = false;
  Measures best;  // the finest level, its numbers extrapolated or means over starts
  std::map<std::string, ReferenceValue, std::less<>> values;
};

// V of the two finest levels differs by more at the end: it depends on what no grid resolves.
inline constexpr double chaotic_difference = 30;  // %
bool is_chaotic(std::span<const Measures> levels);

// From the levels k, coarse to fine, at least one; for a chaotic scene also from the coarsest level with
// several starts.
Reference make_reference(std::vector<int> k, std::span<const Measures> levels,
                         std::span<const Measures> starts);

// Of a chaotic scene the uncertainty is the standard error of the difference of two means over starts, else
// it is the reference's.
struct Error {
  double value = 0, uncertainty = 0;  // in the observable's unit

  bool is_below() const { return value < uncertainty; }
};
// By the name of the observable, those that there are.
using Errors = std::map<std::string, Error, std::less<>>;
// Of one run, or of one from each start of a chaotic scene.
Errors errors_of(std::span<const Measures> runs, const Reference&);

// Pareto front: true for points that no other point dominates in cost and error. Points that are not finite
// are never on it.
std::vector<bool> pareto_front(std::span<const double> cost, std::span<const double> error);

// A setting that was run: its cost (s) and its errors.
struct Candidate {
  double cost = 0;
  Errors errors;
};

// The cheapest setting that meets all targets. Empty if there is none.
std::optional<std::size_t> choose(std::span<const Candidate>, std::span<const ErrorTarget>);
// The setting with the smallest largest ratio of error to target, among those that have all these errors.
std::optional<std::size_t> nearest_to(std::span<const Candidate>, std::span<const ErrorTarget>);

}  // namespace myowave::apps
