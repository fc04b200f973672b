// The metric of the deformed sheet on the grid, from the element nodes (Eqs 22a, 24). F is smooth in
// an element and jumps between elements; every FD cell lies inside one element.
//
//   view      shape        unit     access
//   nodes     (nodes, 2)   length   read, of one member
//   metric    see kernels/tissue/metric.hpp; written for one member
#pragma once

#include "kernels/base/tensor2.hpp"
#include "kernels/elastic/kinematics.hpp"
#include "kernels/tissue/metric.hpp"

namespace myowave::transfer {

// The extremes over the centres of all FD cells.
struct DeformationBounds {
  double max_trace_inverse_C = 0;  // 2 undeformed
  double max_stiffness = 0;        // see cell_stiffness
  double min_J = 0;                // det F
};

// The largest rate of a mode of a cell is 4 D / dx^2 times this: that of its two slopes, or of its twist. tr
// C^-1 for the five-point stencil.
template <tissue::Stencil stencil>
KOKKOS_INLINE_FUNCTION double cell_stiffness(const Sym2& C, double det_F) {
  const double inverse_det_C = 1 / (det_F * det_F), tr = trace(C) * inverse_det_C;
  if constexpr (stencil == tissue::Stencil::five_point) return tr;
  const double largest_eigenvalue = 0.5 * (tr + Kokkos::sqrt(Kokkos::max(tr * tr - 4 * inverse_det_C, 0.0)));
  return Kokkos::max(largest_eigenvalue, (1 - 4 * tissue::twist_part(stencil)) * tr);
}

// Writes the metric of one member of the `conservative` form. Holds the scratch that it needs, so
// that a refresh allocates nothing.
template <class ExecutionSpace, class Real, tissue::Stencil stencil = tissue::Stencil::five_point>
class ConservativeTransfer {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;
  using View = EnsembleField<Real, MemorySpace>;
  using Metric = tissue::ConservativeMetric<Real, MemorySpace, stencil>;

  ConservativeTransfer() = default;
  ConservativeTransfer(const tissue::Grid& grid, const elastic::ElementGrid& elements, int cells_per_element)
      : grid_(grid),
        elements_(elements),
        cells_(cells_per_element),
        G11_("myowave::transfer::G11", grid.rows + 1, grid.columns + 1),
        G22_("myowave::transfer::G22", grid.rows + 1, grid.columns + 1),
        sqrt_C_("myowave::transfer::sqrt_C", grid.rows + 1, grid.columns + 1) {}

  // Waits for the bounds; errors are the caller's to raise (min_J <= 0, the stability bound).
  DeformationBounds refresh(const ExecutionSpace& space, const Nodes<MemorySpace>& nodes,
                            const Metric& metric, int member) const {
    const DeformationBounds bounds = cell_pass(space, nodes, metric, member);
    edge_pass(space, metric, member);
    return bounds;
  }

  // Called by refresh(); public because a device lambda may not stand in a private function.
  DeformationBounds cell_pass(const ExecutionSpace& space, const Nodes<MemorySpace>& nodes,
                              const Metric& metric, int m) const {
    const auto elements = elements_;
    const int cells = cells_;
    const auto G11 = G11_, G22 = G22_, sqrt_C = sqrt_C_;
    const double width = 1.0 / cells;
    DeformationBounds bounds;
    Kokkos::parallel_reduce(
        "myowave::transfer::cell_metric",
        Kokkos::RangePolicy<ExecutionSpace>(space, 0, (grid_.rows - 1) * elements.columns),
        KOKKOS_LAMBDA(int strip, double& max_trace, double& max_stiffness, double& min_J) {
          const int i = strip / elements.columns, J = strip % elements.columns, I = i / cells;
          const auto element = elastic::element_nodes(elements, nodes, elements.element(I, J));
          const double xi_2 = (i - I * cells + 0.5) * width;
          for (int c = 0; c < cells; ++c) {
            const Mat2 F = elastic::deformation_gradient(element, (c + 0.5) * width, xi_2, elements.h);
            const Sym2 C = right_cauchy_green(F);
            const double det_F = determinant(F);
            const double inverse_J = 1 / det_F;
            const int j = J * cells + c;
            // G = sqrt C C^-1 = adj(C) / J
            const double twist = tissue::twist_part(stencil) * trace(C) * inverse_J;
            const double half_G12 = -0.5 * C.m12 * inverse_J;
            G11(i + 1, j + 1) = Real(C.m22 * inverse_J - 2 * twist);
            G22(i + 1, j + 1) = Real(C.m11 * inverse_J - 2 * twist);
            metric.diagonal(m, i + 1, j + 1) = Real(twist + half_G12);
            if constexpr (stencil == tissue::Stencil::nine_point)
              metric.antidiagonal(m, i + 1, j + 1) = Real(twist - half_G12);
            sqrt_C(i + 1, j + 1) = Real(det_F);
            max_trace = Kokkos::max(max_trace, trace(C) * inverse_J * inverse_J);
            max_stiffness = Kokkos::max(max_stiffness, cell_stiffness<stencil>(C, det_F));
            min_J = Kokkos::min(min_J, det_F);
          }
        },
        Kokkos::Max<double>(bounds.max_trace_inverse_C), Kokkos::Max<double>(bounds.max_stiffness),
        Kokkos::Min<double>(bounds.min_J));
    return bounds;
  }

  void edge_pass(const ExecutionSpace& space, const Metric& metric, int m) const {
    const auto G11 = G11_, G22 = G22_, sqrt_C = sqrt_C_;
    const Real half = Real(0.5), four_over_dx2 = Real(4 / (grid_.dx * grid_.dx));
    const int rows = grid_.rows, columns = grid_.columns;
    Kokkos::parallel_for(
        "myowave::transfer::edge_weights",
        Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<2>>(space, {0, 0}, {rows, columns}),
        KOKKOS_LAMBDA(int i, int j) {
          // Cells around node (i, j): (i - 1 or i, j - 1 or j), at + 1 in the shifted arrays.
          metric.east(m, i + 1, j + 1) = half * (G11(i, j + 1) + G11(i + 1, j + 1));
          metric.north(m, i + 1, j + 1) = half * (G22(i + 1, j) + G22(i + 1, j + 1));
          metric.inverse_mass(m, i + 1, j + 1) =
              four_over_dx2 / (sqrt_C(i, j) + sqrt_C(i, j + 1) + sqrt_C(i + 1, j) + sqrt_C(i + 1, j + 1));
        });
  }

 private:
  using Scratch = Field<Real, MemorySpace>;
  tissue::Grid grid_;
  elastic::ElementGrid elements_;
  int cells_ = 1;
  // Less twice the twist; shifted by one as ConservativeMetric; entries outside the sheet stay zero.
  Scratch G11_, G22_, sqrt_C_;
};

// Writes the metric of one member of the `expanded` form: at a node on a shared line or corner the
// mean over the elements that meet there.
template <class ExecutionSpace, class Real>
class ExpandedTransfer {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;
  using Metric = tissue::ExpandedMetric<Real, MemorySpace>;

  ExpandedTransfer() = default;
  ExpandedTransfer(const tissue::Grid& grid, const elastic::ElementGrid& elements, int cells_per_element)
      : grid_(grid), elements_(elements), cells_(cells_per_element) {}

  DeformationBounds refresh(const ExecutionSpace& space, const Nodes<MemorySpace>& nodes,
                            const Metric& metric, int m) const {
    const auto elements = elements_;
    const int cells = cells_;
    Kokkos::parallel_for(
        "myowave::transfer::node_metric",
        Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<2>>(space, {0, 0}, {grid_.rows, grid_.columns}),
        KOKKOS_LAMBDA(int i, int j) {
          NodeMetric sum{};
          int adjacent = 0;
          for (int I = Kokkos::max(0, (i - 1) / cells); I <= Kokkos::min(elements.rows - 1, i / cells); ++I)
            for (int J = Kokkos::max(0, (j - 1) / cells); J <= Kokkos::min(elements.columns - 1, j / cells);
                 ++J) {
              sum += node_metric(elastic::element_nodes(elements, nodes, elements.element(I, J)), elements.h,
                                 (j - J * cells) / double(cells), (i - I * cells) / double(cells));
              ++adjacent;
            }
          const double mean = 1.0 / adjacent;
          metric.g11(m, i, j) = Real(mean * sum.g11);
          metric.g12(m, i, j) = Real(mean * sum.g12);
          metric.g22(m, i, j) = Real(mean * sum.g22);
          metric.b1(m, i, j) = Real(mean * sum.b1);
          metric.b2(m, i, j) = Real(mean * sum.b2);
        });
    return bounds(space, nodes);
  }

  struct NodeMetric {
    double g11, g12, g22, b1, b2;
    KOKKOS_INLINE_FUNCTION void operator+=(const NodeMetric& o) {
      g11 += o.g11, g12 += o.g12, g22 += o.g22, b1 += o.b1, b2 += o.b2;
    }
  };

  // C^-1 and b^N = 2 g^12 (F^-1)^N_k x_k,12 inside one element.
  KOKKOS_INLINE_FUNCTION static NodeMetric node_metric(const elastic::ElementNodes& element, double h,
                                                       double xi_1, double xi_2) {
    const Mat2 F = elastic::deformation_gradient(element, xi_1, xi_2, h);
    const Sym2 g = inverse(right_cauchy_green(F));
    const double inverse_J = 1 / determinant(F);
    // x_,12 is constant in a bilinear element.
    const auto mixed = [&](int k) {
      return (element.x[0][k] - element.x[1][k] - element.x[2][k] + element.x[3][k]) / (h * h);
    };
    const double x_12 = mixed(0), y_12 = mixed(1);
    return {g.m11, g.m12, g.m22, 2 * g.m12 * inverse_J * (F.m22 * x_12 - F.m12 * y_12),
            2 * g.m12 * inverse_J * (F.m11 * y_12 - F.m21 * x_12)};
  }

  DeformationBounds bounds(const ExecutionSpace& space, const Nodes<MemorySpace>& nodes) const {
    const auto elements = elements_;
    const int cells = cells_;
    DeformationBounds result;
    Kokkos::parallel_reduce(
        "myowave::transfer::deformation_bounds",
        Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<2>>(space, {0, 0},
                                                               {grid_.rows - 1, grid_.columns - 1}),
        KOKKOS_LAMBDA(int i, int j, double& max_trace, double& min_J) {
          const int I = i / cells, J = j / cells;
          const auto element = elastic::element_nodes(elements, nodes, elements.element(I, J));
          const Mat2 F = elastic::deformation_gradient(element, (j - J * cells + 0.5) / cells,
                                                       (i - I * cells + 0.5) / cells, elements.h);
          const double det_F = determinant(F);
          max_trace = Kokkos::max(max_trace, trace(right_cauchy_green(F)) / (det_F * det_F));
          min_J = Kokkos::min(min_J, det_F);
        },
        Kokkos::Max<double>(result.max_trace_inverse_C), Kokkos::Min<double>(result.min_J));
    result.max_stiffness = result.max_trace_inverse_C;
    return result;
  }

 private:
  tissue::Grid grid_;
  elastic::ElementGrid elements_;
  int cells_ = 1;
};

}  // namespace myowave::transfer
