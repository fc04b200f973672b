#include "solver/stability_maps.hpp"

namespace myowave::solver {

const std::vector<StabilityMap>& stability_maps() {
  static const std::vector<StabilityMap> maps{};
  return maps;
}

}  // namespace myowave::solver
