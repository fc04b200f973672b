// Bisection.
#pragma once

#include <fmt/format.h>

#include <stdexcept>

namespace myowave::solver {

// An interval that holds a root; its length bounds the error.
struct Bracket {
  double low = 0, high = 0;

  double middle() const { return 0.5 * (low + high); }
};

// Halves the bracket around the place where `is_below(x)` turns from true to false, until it is not longer
// than `tolerance` or no floating-point number is left between its ends. With tolerance 0, middle() is thus
// within one rounding of the root. If is_below is the same everywhere, the bracket shrinks to that end.
// Errors: std::invalid_argument if low > high.
template <class Predicate>
Bracket bisect(Bracket bracket, double tolerance, const Predicate& is_below) {
  if (bracket.low > bracket.high) {
    throw std::invalid_argument(fmt::format("bisect: [{}, {}] is no interval", bracket.low, bracket.high));
  }
  while (bracket.high - bracket.low > tolerance) {
    const double middle = bracket.middle();
    if (middle <= bracket.low || middle >= bracket.high) break;
    (is_below(middle) ? bracket.low : bracket.high) = middle;
  }
  return bracket;
}

}  // namespace myowave::solver
