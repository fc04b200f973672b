// The residual and the tangent of the sheet: assembled on the device, compressed to the unknowns,
// read on the host, where the factorisation runs.
#pragma once

#include <Kokkos_Core.hpp>
#include <span>
#include <string>
#include <vector>

#include "kernels/base/views.hpp"
#include "kernels/elastic/assemble.hpp"
#include "solver/mechanics/mesh.hpp"

namespace myowave::solver {

template <class ExecutionSpace>
class SparseSystem {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;

  SparseSystem(const ExecutionSpace& space, const Mesh& mesh)
      : unknown_(mesh.unknown),
        gradient_product_(mesh.gradient_product),
        slot_source_(to_device(space, "myowave::elastic::slot_source", mesh.slot_node_entry)),
        element_("myowave::elastic::element", elastic::linearization_entries, elastic::places(mesh.grid)),
        nodal_tangent_("myowave::elastic::nodal_tangent", elastic::NodalTangent::entries, mesh.grid.nodes()),
        nodal_residual_("myowave::elastic::nodal_residual", mesh.grid.nodes()),
        values_("myowave::elastic::tangent", mesh.column.size()),
        nodal_residual_host_(Kokkos::create_mirror_view(nodal_residual_)),
        values_host_(Kokkos::create_mirror_view(values_)),
        residual_(mesh.unknowns),
        shifted_(mesh.column.size()) {}

  void assemble(const ExecutionSpace& space, const elastic::Membrane& membrane,
                const elastic::ElementGrid& grid, const Nodes<MemorySpace>& nodes,
                const GaussTension<MemorySpace>& Ta) {
    elastic::linearize_elements(space, membrane, grid, nodes, Ta, element_);
    elastic::gather_nodes(space, grid, element_, nodal_residual_, nodal_tangent_);
    elastic::gather_tangent(space, slot_source_, nodal_tangent_, values_);
    Kokkos::deep_copy(space, nodal_residual_host_, nodal_residual_);
    Kokkos::deep_copy(space, values_host_, values_);
    space.fence("myowave::elastic::assemble");
    for (std::size_t a = 0; a < unknown_.size(); ++a) {
      if (unknown_[a] >= 0) residual_[unknown_[a]] = nodal_residual_host_(a / 2, a % 2);
    }
  }

  // kPa x length, an entry an unknown.
  std::span<const double> residual() const { return {residual_.data(), residual_.size()}; }
  // K + shift L in kPa, lower triangle in the order of Mesh::column; L as in Mesh::gradient_product.
  std::span<const double> tangent(double shift) {
    const std::span<const double> K{values_host_.data(), values_host_.extent(0)};
    if (shift == 0) return K;
    for (std::size_t slot = 0; slot < K.size(); ++slot)
      shifted_[slot] = K[slot] + shift * gradient_product_[slot];
    return {shifted_.data(), shifted_.size()};
  }
  // At all nodes (nodes, 2): what is left at held components is the force that holds them.
  const auto& nodal_residual() const { return nodal_residual_host_; }

  // Spreads a vector over the unknowns to the nodes, zero at held components.
  template <class HostNodes>
  void scatter(std::span<const double> vector, const HostNodes& nodes) const {
    for (std::size_t a = 0; a < unknown_.size(); ++a) {
      nodes(a / 2, a % 2) = unknown_[a] >= 0 ? vector[unknown_[a]] : 0.0;
    }
  }

 private:
  static elastic::Indices<MemorySpace> to_device(const ExecutionSpace& space, const std::string& label,
                                                 const std::vector<int>& host) {
    elastic::Indices<MemorySpace> device(Kokkos::view_alloc(space, Kokkos::WithoutInitializing, label),
                                         host.size());
    Kokkos::deep_copy(
        space, device,
        Kokkos::View<const int*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(host.data(), host.size()));
    space.fence("myowave::elastic::to_device");
    return device;
  }

  std::vector<int> unknown_;
  std::vector<double> gradient_product_;
  elastic::Indices<MemorySpace> slot_source_;
  elastic::Rows<MemorySpace> element_;
  elastic::Rows<MemorySpace> nodal_tangent_;
  Nodes<MemorySpace> nodal_residual_;
  elastic::Numbers<MemorySpace> values_;
  typename Nodes<MemorySpace>::host_mirror_type nodal_residual_host_;
  typename elastic::Numbers<MemorySpace>::host_mirror_type values_host_;
  std::vector<double> residual_;
  std::vector<double> shifted_;
};

}  // namespace myowave::solver
