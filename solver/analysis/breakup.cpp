#include "solver/analysis/breakup.hpp"

#include <algorithm>

namespace myowave::solver {

void BreakupWatch::add_sample(double t, int tips, double largest_V, bool more_stimuli) {
  if (!death_ && largest_V < quiet_below && !more_stimuli) death_ = t;
  if (breakup_ || t < from_) return;
  if (!limit_) limit_ = std::max(1, tips);
  if (tips <= *limit_) {
    candidate_.reset();
    return;
  }
  if (!candidate_) candidate_ = t;
  if (t - *candidate_ >= must_last - 1e-9) breakup_ = candidate_;
}

}  // namespace myowave::solver
