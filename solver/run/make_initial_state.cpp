#include "solver/run/make_initial_state.hpp"

#include "solver/base/error.hpp"

namespace myowave::solver {

InitialState make_initial_state(const Scene& scene) {
  const int rows = scene.grid.rows, columns = scene.grid.columns;
  const auto nodes = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  InitialState state{rows, columns, std::vector<double>(nodes), std::vector<double>(nodes),
                     std::vector<double>(nodes)};
  switch (scene.initial.type) {
    case InitialSettings::Type::rest:
      return state;
    case InitialSettings::Type::broken_front: {
      const int cx = (columns - 1) / 2 + scene.initial.offset[0];
      const int cy = (rows - 1) / 2 + scene.initial.offset[1];
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
          const auto node = static_cast<std::size_t>(i) * columns + j;
          if (cx - scene.initial.width < j && j <= cx && i <= cy) state.V[node] = 1;
          if (j <= cx - scene.initial.width) state.r[node] = scene.initial.r0;
        }
      return state;
    }
    case InitialSettings::Type::settled_spiral:
    case InitialSettings::Type::file:
      break;
  }
  throw InputError("this initial state comes from a file or from the cache, not from a formula");
}

}  // namespace myowave::solver
