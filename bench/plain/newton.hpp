// The yardstick of the mechanics: Newton's method with a new tangent and a sparse factorisation in
// every iteration, started from the last solution. Its loops are a copy that does not change. The physics of
// one element (kernels/elastic/element.hpp), the pattern of the tangent (solver/mechanics/mesh.hpp) and the
// sparse factorisation (solver/mechanics/linear/direct_solver.hpp) are the product's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/elastic/element.hpp"
#include "solver/mechanics/linear/direct_solver.hpp"
#include "solver/mechanics/mesh.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::plain {

// Time of the phases of all solves.
struct NewtonEffort {
  std::int64_t solves = 0, iterations = 0, factorizations = 0;
  double energy_s = 0, assemble_s = 0, factorize_s = 0, solve_s = 0;
};

class Newton {
 public:
  Newton(const elastic::ElementGrid&, const solver::MechanicsSettings&);

  // Equilibrium with Ta (elements, 4), kPa. Throws std::runtime_error if it finds none.
  void solve(std::span<const double> Ta);

  // x1, x2 of every node.
  const std::vector<double>& nodes() const { return nodes_; }
  const NewtonEffort& effort() const { return effort_; }

 private:
  struct Evaluation {
    double energy = 0, min_J = 0;
    bool admissible() const;
  };

  bool minimise(std::span<const double> Ta);
  // One direction and its line search; true if a step was accepted.
  bool step(std::span<const double> Ta, double residual, double shift, Evaluation& current);
  Evaluation evaluate(std::span<const double> Ta, const std::vector<double>& x);
  void assemble(std::span<const double> Ta);

  solver::Mesh mesh_;
  solver::MechanicsSettings settings_;
  elastic::Membrane membrane_;
  solver::DirectSolver solver_;
  double energy_unit_;
  bool solved_ = false;
  std::vector<double> nodes_, current_, tried_, last_Ta_;
  std::vector<double> element_energy_, element_J_;
  std::vector<elastic::ElementLinearization> element_;
  std::vector<double> nodal_residual_, residual_, direction_, tangent_, shifted_;
  NewtonEffort effort_;
};

}  // namespace myowave::plain
