// Static equilibrium of the loaded, actively stressed membrane: the state, its solver, its report.
#pragma once

#include <Kokkos_Core.hpp>
#include <cstdint>
#include <memory>

#include "kernels/base/views.hpp"
#include "kernels/elastic/element_grid.hpp"
#include "solver/base/archive.hpp"
#include "solver/mechanics/newton.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Cost and result of one solve.
struct SolveReport {
  std::int64_t iterations = 0;
  std::int64_t factorizations = 0;
  std::int64_t shifts = 0;      // factorisations of K + mu L, see solver/mechanics/newton.hpp
  std::int64_t ramp_steps = 0;  // 0: Ta was applied at once
  double residual = 0;          // max|R_free| / (10 kPa h) at the end
  double energy = 0;            // Pi at the end, kPa x area
  double min_J = 0;             // smallest det F at any corner of any element
  int not_elliptic = 0;         // Gauss points where the membrane has lost ellipticity
  PhaseTimes time;
};

template <class ExecutionSpace>
class Equilibrium {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;

  // Starts undeformed. Analyses the sparsity pattern once.
  Equilibrium(const ExecutionSpace&, const elastic::ElementGrid&, const MechanicsSettings&);
  ~Equilibrium();
  Equilibrium(Equilibrium&&) noexcept;
  Equilibrium& operator=(Equilibrium&&) noexcept;

  // Brings the nodes to equilibrium with the tension (kPa, at the Gauss points), starting from the
  // last solution, or, if there is none, from the uniform one for the mean tension. On failure
  // the nodes keep the last solution.
  // Errors: NumericalFailure with time, Ta range, min J and what was tried; without iterating if
  // the sheet has no stable rest state.
  SolveReport solve(const ExecutionSpace&, const GaussTension<MemorySpace>& Ta, double time);

  // Whether the nodes are in equilibrium with exactly this tension: a solve would find its residual small
  // enough at once and move none of them.
  bool is_solved_for(const ExecutionSpace&, const GaussTension<MemorySpace>& Ta) const;

  // Current positions, length units; written by solve().
  const Nodes<MemorySpace>& nodes() const;
  // Back to the undeformed sheet.
  void reset(const ExecutionSpace&);

  const elastic::ElementGrid& grid() const;

  // Everything that the next solve depends on. Of the last factor, which a solve starts with, only the inputs
  // are saved: load() factorises again, with a bitwise identical result. Errors: StateMismatch.
  void save(StateWriter&) const;
  void load(const ExecutionSpace&, StateReader&);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace myowave::solver
