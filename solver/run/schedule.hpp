// What a stage of a run does at which step.
#pragma once

#include <cstdint>

#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Steps between two fields, two samples of tips, and so on; at least 1, but mechanics is 0 in a rigid sheet.
// All except mechanics are due at the last step too.
struct Schedule {
  std::int64_t last, fields, tips, probes, watch, maps, mechanics, check;
  double fields_from;  // in steps; a double, because it can exceed the range of integers

  static constexpr std::int64_t check_without_mechanics = 100;  // steps between checks for non-finite values

  explicit Schedule(const Scene&);

  bool due(std::int64_t step, std::int64_t period) const { return step == last || step % period == 0; }
  bool fields_due(std::int64_t step) const {
    return due(step, fields) && (step == last || static_cast<double>(step) >= fields_from);
  }
  // The next step after this one at which anything is due.
  std::int64_t next(std::int64_t step) const;
};

}  // namespace myowave::solver
