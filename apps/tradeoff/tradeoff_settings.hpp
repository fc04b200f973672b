// The dials of accuracy against speed, and the settings of them that `myowave tradeoff` tries.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::apps {

// A key of the scene that trades accuracy for speed.
struct Dial {
  std::string_view key;
  std::string_view values;  // default values; those of accuracy.dx in units of grid.dx
  bool elastic;             // no effect on a rigid sheet
  std::string_view doc;
};

std::span<const Dial> dials();

struct DialValues {
  std::string key;
  std::vector<std::string> values;

  bool operator==(const DialValues&) const = default;
};

// From --axes: "time.dt=0.01,0.02;accuracy.scheme=euler,split", or names alone, "time.dt,precision", for the
// values of the table; a name may be the last part of the key. All dials that act on the scene for "", none
// for "none".
// Errors: InputError with the nearest dial; for one that has no effect on the scene.
std::vector<DialValues> parse_axes(std::string_view text, const solver::Scene&);

// Its overrides, "section.key=value", are put over the scene and those of the user.
struct Setting {
  std::string name;
  std::vector<std::string> overrides;
};

// The presets; then from those that are `varied` each dial alone, or all combinations of their values.
// Errors: InputError where there are too many combinations.
std::vector<Setting> make_settings(std::span<const DialValues>, bool product);

// The reference on a grid k times finer than grid.dx: the preset `reference` with dt proportional to dx^2, at
// most C_m dx^2 / (6 D), half of it where the sheet contracts, and solves of the mechanics each 0.4 / k t.u.
// Where the metric is `expanded`, the scheme is the one that has it.
std::vector<std::string> reference_overrides(const solver::Scene& own, int k);

// Of --target: the largest error of an observable, in the unit that its errors have.
struct ErrorTarget {
  std::string observable;
  double largest = 0;
};

// "period=1%,cv=2%". Errors: InputError with the nearest observable.
std::vector<ErrorTarget> parse_targets(const std::vector<std::string>& texts);

// "2,3,4", three grids from coarse to fine. Errors: InputError.
std::vector<int> parse_levels(std::string_view text);

}  // namespace myowave::apps
