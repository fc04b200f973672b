// What a quantity tends to on ever finer grids, and how fast, from three of them.
#pragma once

#include <array>
#include <optional>
#include <span>

namespace myowave::solver {

// p of v_k = v* + C h_k^p, from the differences v_1 - v_2 and v_2 - v_3 (or their norms) at spacings
// h_1 > h_2 > h_3 of any ratio. None where the values do not move one way, or p is not within 0.25 to 8.
std::optional<double> observed_order(const std::array<double, 3>& h, double first_difference,
                                     double second_difference);

struct Extrapolated {
  double value = 0;
  double uncertainty = 0;  // in the unit of the value; nan where it is not known
  std::optional<double> order{};
};

// The limit v* where three levels have an order; its uncertainty is its distance from the finest level. Else,
// also where they differ by less than 1e-9 of the value, the finest level, uncertain by its distance from the
// one before. Levels from coarse to fine, at least one.
Extrapolated richardson(std::span<const double> h, std::span<const double> values);

}  // namespace myowave::solver
