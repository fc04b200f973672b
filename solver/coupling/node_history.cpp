#include "solver/coupling/node_history.hpp"

#include <algorithm>

#include "kernels/elastic/kinematics.hpp"
#include "solver/base/lagrange.hpp"

namespace myowave::solver {
namespace {

bool turns_a_corner(const elastic::ElementGrid& grid, const NodeHistory::HostNodes& nodes) {
  for (int e = 0; e < grid.elements(); ++e)
    if (!(elastic::min_corner_J(elastic::element_nodes(grid, nodes, e), grid.h) > 0)) return true;
  return false;
}

}  // namespace

NodeHistory::NodeHistory(const elastic::ElementGrid& grid, std::size_t solves) : grid_(grid), kept_(solves) {
  for (std::size_t n = 0; n < kept_; ++n)
    solves_[n].nodes = HostNodes("myowave::solver::node_history", grid.nodes());
  if (kept_ > 1) placed_ = HostNodes("myowave::solver::extrapolated_nodes", grid.nodes());
}

bool NodeHistory::add(double t, const HostNodes& nodes) {
  const std::span<const double> added(nodes.data(), nodes.size());
  const bool moved = empty() || !std::ranges::equal(added, std::span(last().data(), last().size()));
  std::rotate(solves_.begin(), solves_.begin() + kept_ - 1, solves_.begin() + kept_);
  solves_[0].t = t;
  std::ranges::copy(added, solves_[0].nodes.data());
  known_ = std::min(known_ + 1, kept_);
  return moved;
}

const NodeHistory::HostNodes& NodeHistory::at(double t) {
  for (std::size_t solves = known_; solves > 1; --solves) {
    place(t, solves);
    if (!turns_a_corner(grid_, placed_)) return placed_;
  }
  return last();
}

// Adds weighted differences to the last nodes, so that nodes that have not moved stay bitwise the same.
void NodeHistory::place(double t, std::size_t solves) {
  std::array<double, most_solves> times{};
  std::ranges::transform(solves_, times.begin(), &Solve::t);
  const auto weights = lagrange_weights(std::span(times).first(solves), t);
  const double* const newest = last().data();
  std::copy_n(newest, placed_.size(), placed_.data());
  for (std::size_t n = 1; n < solves; ++n) {
    const double* const older = solves_[n].nodes.data();
    for (std::size_t k = 0; k < placed_.size(); ++k) placed_.data()[k] += weights[n] * (older[k] - newest[k]);
  }
}

}  // namespace myowave::solver
