// The sizes of what a run shows, and where its grid nodes are.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/scene/scene.hpp"

namespace myowave::apps {

// A deforming sheet has elements of `cells` x `cells` grid cells; a rigid one has none (0).
struct FrameShape {
  int rows = 0;  // grid nodes
  int columns = 0;
  int cells = 0;
  double dx = 0;
  bool tension = true;  // Ta is computed

  bool deforms() const { return cells > 0; }
  int element_rows() const { return deforms() ? (rows - 1) / cells : 0; }
  int element_columns() const { return deforms() ? (columns - 1) / cells : 0; }
  std::size_t element_nodes() const {
    return deforms() ? std::size_t(element_rows() + 1) * std::size_t(element_columns() + 1) : 0;
  }
  std::size_t grid_nodes() const { return std::size_t(rows) * std::size_t(columns); }
};

FrameShape frame_shape(const solver::Scene&);

// Positions (row, column, {x1, x2}) of the grid nodes of a deformed sheet: bilinear in each element.
std::vector<float> grid_positions(const FrameShape&, std::span<const double> nodes);

}  // namespace myowave::apps
