// The nodes of the last solves of the mechanics, and their extrapolation in time by the polynomial through
// them.
#pragma once

#include <Kokkos_Core.hpp>
#include <array>
#include <cstddef>

#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"

namespace myowave::solver {

class NodeHistory {
 public:
  using HostNodes = Nodes<Kokkos::HostSpace>;  // length units
  static constexpr std::size_t most_solves = 3;

  NodeHistory() = default;
  // Stores the last `solves`, 1 to most_solves.
  NodeHistory(const elastic::ElementGrid&, std::size_t solves);

  bool empty() const { return known_ == 0; }

  // Nodes in equilibrium at t, later than all before. True if one has moved since the last call.
  bool add(double t, const HostNodes&);

  // Of the last solve; before the first all zero.
  const HostNodes& last() const { return solves_[0].nodes; }

  // Extrapolated nodes at t, not before the last solve: by the polynomial through all stored solves, or
  // through fewer if that inverts a corner of an element, at last the last nodes themselves. Valid until the
  // next call.
  const HostNodes& at(double t);

  template <class Archive>
  void state(Archive& archive) {
    archive(known_);
    for (Solve& solve : solves_) archive(solve.t, solve.nodes);
  }

 private:
  struct Solve {
    double t = 0;
    HostNodes nodes;
  };
  void place(double t, std::size_t solves);

  elastic::ElementGrid grid_;
  std::array<Solve, most_solves> solves_;  // the last one first; empty beyond kept_
  std::size_t kept_ = 0, known_ = 0;
  HostNodes placed_;
};

}  // namespace myowave::solver
