#include "solver/mechanics/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "kernels/elastic/assemble.hpp"
#include "kernels/elastic/element.hpp"
#include "solver/base/error.hpp"

namespace myowave::solver {
namespace {

// Unknown of dof a = 2 c + i of element e.
int element_unknown(const Mesh& mesh, int e, int a) {
  return mesh.unknown[2 * mesh.grid.corner(e, a / 2) + a % 2];
}

// Rows of the lower triangle: node n couples with itself and the up to eight nodes around it, and
// unknowns ascend with the nodes.
void build_pattern(Mesh& mesh) {
  const auto& grid = mesh.grid;
  mesh.row_begin.assign(1, 0);
  for (int I = 0; I <= grid.rows; ++I) {
    for (int J = 0; J <= grid.columns; ++J) {
      for (int i = 0; i < 2; ++i) {
        const int row = mesh.unknown[2 * grid.node(I, J) + i];
        if (row < 0) continue;
        for (int K = std::max(I - 1, 0); K <= std::min(I + 1, grid.rows); ++K) {
          for (int L = std::max(J - 1, 0); L <= std::min(J + 1, grid.columns); ++L) {
            for (int j = 0; j < 2; ++j) {
              const int column = mesh.unknown[2 * grid.node(K, L) + j];
              if (column >= 0 && column <= row) mesh.column.push_back(column);
            }
          }
        }
        mesh.row_begin.push_back(static_cast<int>(mesh.column.size()));
      }
    }
  }
}

int slot_of(const Mesh& mesh, int row, int column) {
  const auto first = mesh.column.begin() + mesh.row_begin[row];
  const auto last = mesh.column.begin() + mesh.row_begin[row + 1];
  return static_cast<int>(std::lower_bound(first, last, column) - mesh.column.begin());
}

// Calls visit(slot, source) for every entry of every element's tangent that is in the system, in
// the order of the elements.
template <class Visit>
void for_each_source(const Mesh& mesh, Visit visit) {
  for (int e = 0; e < mesh.grid.elements(); ++e) {
    for (int a = 0; a < elastic::element_dofs; ++a) {
      for (int b = 0; b <= a; ++b) {
        const int row = element_unknown(mesh, e, a), column = element_unknown(mesh, e, b);
        if (row < 0 || column < 0) continue;
        visit(slot_of(mesh, std::max(row, column), std::min(row, column)),
              elastic::tangent_entries * e + elastic::tangent_entry(a, b));
      }
    }
  }
}

void build_gather(Mesh& mesh) {
  mesh.slot_begin.assign(mesh.column.size() + 1, 0);
  for_each_source(mesh, [&](int slot, int) { ++mesh.slot_begin[slot + 1]; });
  std::partial_sum(mesh.slot_begin.begin(), mesh.slot_begin.end(), mesh.slot_begin.begin());
  mesh.slot_source.resize(mesh.slot_begin.back());
  std::vector<int> next(mesh.slot_begin.begin(), mesh.slot_begin.end() - 1);
  for_each_source(mesh, [&](int slot, int source) { mesh.slot_source[next[slot]++] = source; });
}

void build_node_entries(Mesh& mesh) {
  using elastic::NodalTangent;
  const auto& grid = mesh.grid;
  mesh.slot_node_entry.resize(mesh.column.size());
  const auto place = [&](int n, int i, int m, int j, int entry) {
    const int row = mesh.unknown[2 * n + i], column = mesh.unknown[2 * m + j];
    if (row >= 0 && column >= 0) mesh.slot_node_entry[slot_of(mesh, row, column)] = entry * grid.nodes() + n;
  };
  for (int I = 0; I <= grid.rows; ++I) {
    for (int J = 0; J <= grid.columns; ++J) {
      const int n = grid.node(I, J);
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j <= i; ++j) place(n, i, n, j, NodalTangent::self + i + j);
        for (int k = 0; k < NodalTangent::neighbours; ++k) {
          const int K = I + NodalTangent::row(k), L = J + NodalTangent::column(k);
          if (K < 0 || L < 0 || L > grid.columns) continue;
          for (int j = 0; j < 2; ++j) place(n, i, grid.node(K, L), j, 4 * k + 2 * i + j);
        }
      }
    }
  }
}

// Integral of grad u : grad v over one element, for the tangent entry of dofs (a, b).
double element_gradient_product(int a, int b) {
  if (a % 2 != b % 2) return 0;
  double sum = 0;
  for (int q = 0; q < elastic::gauss_points; ++q) {
    const double xi_1 = elastic::gauss_coordinate(q % 2), xi_2 = elastic::gauss_coordinate(q / 2);
    const auto g = elastic::shape_gradient(a / 2, xi_1, xi_2, 1),
               k = elastic::shape_gradient(b / 2, xi_1, xi_2, 1);
    sum += 0.25 * (g.d1 * k.d1 + g.d2 * k.d2);
  }
  return sum;
}

void build_gradient_product(Mesh& mesh) {
  std::vector<double> element(elastic::tangent_entries);
  for (int a = 0; a < elastic::element_dofs; ++a) {
    for (int b = 0; b <= a; ++b) element[elastic::tangent_entry(a, b)] = element_gradient_product(a, b);
  }
  mesh.gradient_product.assign(mesh.column.size(), 0);
  for (std::size_t slot = 0; slot < mesh.column.size(); ++slot) {
    for (int k = mesh.slot_begin[slot]; k < mesh.slot_begin[slot + 1]; ++k) {
      mesh.gradient_product[slot] += element[mesh.slot_source[k] % elastic::tangent_entries];
    }
  }
}

}  // namespace

int middle_node(const elastic::ElementGrid& grid) { return grid.node(grid.rows / 2, grid.columns / 2); }

std::vector<bool> held_components(const elastic::ElementGrid& grid, Edges edges) {
  std::vector<bool> held(2 * static_cast<std::size_t>(grid.nodes()), false);
  if (edges == Edges::load) {
    const int middle = middle_node(grid);
    held[2 * middle] = held[2 * middle + 1] = true;
    held[2 * (middle + 1) + 1] = true;
    return held;
  }
  for (int I = 0; I <= grid.rows; ++I) {
    for (int J = 0; J <= grid.columns; ++J) {
      if (I > 0 && I < grid.rows && J > 0 && J < grid.columns) continue;
      held[2 * grid.node(I, J)] = held[2 * grid.node(I, J) + 1] = true;
    }
  }
  return held;
}

Mesh make_mesh(const elastic::ElementGrid& grid, Edges edges) {
  if (grid.rows < 1 || grid.columns < 1 || !(grid.h > 0)) {
    throw InputError(fmt::format(
        "the element mesh is {} x {} with edge length {}: it needs at least one element each way and a "
        "positive length; use a larger grid or fewer cells_per_element",
        grid.rows, grid.columns, grid.h));
  }
  if (static_cast<std::int64_t>(grid.rows) * grid.columns >
      std::numeric_limits<int>::max() / (4 * elastic::tangent_entries)) {
    throw InputError(fmt::format("the element mesh of {} x {} is too large; use more cells_per_element",
                                 grid.rows, grid.columns));
  }
  Mesh mesh;
  mesh.grid = grid;
  for (const bool held : held_components(grid, edges)) {
    mesh.unknown.push_back(held ? -1 : mesh.unknowns++);
  }
  build_pattern(mesh);
  build_gather(mesh);
  build_node_entries(mesh);
  build_gradient_product(mesh);
  return mesh;
}

}  // namespace myowave::solver
