// The nodes of the last solves of the mechanics, and where these let the nodes be expected later: by the
// polynomial through them in time.
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
  // Keeps the last `solves`, 1 to most_solves.
  NodeHistory(const elastic::ElementGrid&, std::size_t solves);

  bool empty() const { return known_ == 0; }

  // Those in equilibrium at t, which is later than all before. True where one has moved since.
  bool add(double t, const HostNodes&);

  // Of the last solve; before the first all zero.
  const HostNodes& last() const { return solves_[0].nodes; }

  // Where the nodes are expected at t, not before the last solve: by the polynomial through as many solves as
  // are known, or of fewer where it turns a corner of an element inside out, in the end the last nodes
  // themselves. Valid until the next call.
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
  std::array<Solve, most_solves> solves_;  // the last one first; empty past those that are kept
  std::size_t kept_ = 0, known_ = 0;
  HostNodes placed_;
};

}  // namespace myowave::solver
