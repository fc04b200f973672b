#include "apps/draw/frame_shape.hpp"

#include <algorithm>

namespace myowave::apps {

FrameShape frame_shape(const solver::Scene& scene) {
  return {scene.grid.rows, scene.grid.columns, scene.mechanics ? scene.mechanics->cells_per_element : 0,
          scene.grid.dx, solver::has_tension(scene)};
}

std::vector<float> grid_positions(const FrameShape& shape, std::span<const double> nodes) {
  std::vector<float> x(2 * shape.grid_nodes());
  const std::size_t pitch = 2 * std::size_t(shape.element_columns() + 1);
  std::size_t at = 0;
  for (int i = 0; i < shape.rows; ++i) {
    const int I = std::min(i / shape.cells, shape.element_rows() - 1);
    const double eta = double(i - I * shape.cells) / shape.cells;
    for (int j = 0; j < shape.columns; ++j) {
      const int J = std::min(j / shape.cells, shape.element_columns() - 1);
      const double xi = double(j - J * shape.cells) / shape.cells;
      const std::size_t corner = std::size_t(I) * pitch + 2 * std::size_t(J);
      for (std::size_t c = 0; c < 2; ++c, ++at) {
        const double low = (1 - xi) * nodes[corner + c] + xi * nodes[corner + 2 + c];
        const double high = (1 - xi) * nodes[corner + pitch + c] + xi * nodes[corner + pitch + 2 + c];
        x[at] = static_cast<float>((1 - eta) * low + eta * high);
      }
    }
  }
  return x;
}

}  // namespace myowave::apps
