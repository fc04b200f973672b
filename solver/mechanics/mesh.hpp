// What the sparse system needs of the element mesh: unknowns, held displacements, the pattern of
// the tangent and the elements that feed each of its slots. Host data, built once.
#pragma once

#include <vector>

#include "kernels/elastic/element_grid.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

struct Mesh {
  elastic::ElementGrid grid;
  // Unknown of component i of node n at [2 n + i]; -1 where it is held.
  std::vector<int> unknown;
  int unknowns = 0;

  // Lower triangle of the tangent in compressed rows, columns ascending, the diagonal last.
  std::vector<int> row_begin;  // unknowns + 1
  std::vector<int> column;     // a slot each

  // By slot, where it stands among the entries of its node: entry nodes + node, see
  // elastic::NodalTangent.
  std::vector<int> slot_node_entry;

  // Slot s sums the element tangent entries slot_source[slot_begin[s] ... slot_begin[s + 1]), each
  // 36 element + entry of the element's lower triangle.
  std::vector<int> slot_begin;
  std::vector<int> slot_source;

  // By slot, the matrix of the integral of grad u : grad v: what a unit isotropic tension adds to
  // the tangent.
  std::vector<double> gradient_product;
};

// The node in the middle of the sheet, at which a loaded sheet is held.
int middle_node(const elastic::ElementGrid&);

// Components [2 n + i] that are held at their undeformed positions. Edges::load: the middle
// node, and the X2 component of its right neighbour, which leaves no rigid motion;
// Edges::fixed: every boundary node.
std::vector<bool> held_components(const elastic::ElementGrid&, Edges);

// Errors: InputError if the mesh is empty or has no unknown.
Mesh make_mesh(const elastic::ElementGrid&, Edges);

}  // namespace myowave::solver
