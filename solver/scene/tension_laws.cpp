#include "solver/scene/tension_laws.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "solver/base/error.hpp"

namespace myowave::solver {

TensionLaw tension_law(std::string_view name) {
  const auto found = std::ranges::find(tension_laws, name, &NamedTensionLaw::name);
  if (found != tension_laws.end()) return static_cast<TensionLaw>(found - tension_laws.begin());
  std::string names;
  for (const NamedTensionLaw& law : tension_laws) names += fmt::format(" \"{}\"", law.name);
  throw InputError(fmt::format("there is no tension law \"{}\"; laws:{}", name, names));
}

}  // namespace myowave::solver
