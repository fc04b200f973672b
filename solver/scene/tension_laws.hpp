// The laws of the active tension (Eqs 22c, 23) by name, and the settings that choose one.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "kernels/cell/parameters.hpp"

namespace myowave::solver {

// In the order of `tension_laws`.
enum class TensionLaw { delayed, printed, none };

// Ta relaxes to k_Ta V at the rate eps_below where V is below the threshold, else at eps_above.
struct NamedTensionLaw {
  std::string_view name;
  double eps_below, eps_above;  // 1/t.u.
};

// `delayed` peaks at 185 ms and shortens the sheet by 25 %, as Fig 2a shows; `printed` is Eq 23 with eps0 =
// 1; with `none` there is no Ta to relax.
inline constexpr std::array<NamedTensionLaw, 3> tension_laws{
    {{"delayed", cell::ActiveTensionParameters<double>{}.eps_below,
      cell::ActiveTensionParameters<double>{}.eps_above},
     {"printed", 1, 10},
     {"none", 0, 0}}};

// The row of a law in `tension_laws`.
constexpr const NamedTensionLaw& row_of(TensionLaw law) {
  return tension_laws[static_cast<std::size_t>(law)];
}

// The law of this name. Errors: InputError where there is none.
TensionLaw tension_law(std::string_view name);

struct TensionSettings {
  TensionLaw law = TensionLaw::delayed;
  double k_Ta = cell::ActiveTensionParameters<double>{}.k_Ta;  // kPa
  std::optional<double> eps_below{}, eps_above{};              // 1/t.u., in place of the law's rates
  double threshold = cell::ActiveTensionParameters<double>{}.threshold;
};

// With the law's rates, or those in their place.
constexpr cell::ActiveTensionParameters<double> tension_parameters(const TensionSettings& settings) {
  const NamedTensionLaw& law = row_of(settings.law);
  return {settings.k_Ta, settings.eps_below.value_or(law.eps_below),
          settings.eps_above.value_or(law.eps_above), settings.threshold};
}

}  // namespace myowave::solver
