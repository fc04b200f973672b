#include "solver/mechanics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/elastic/assemble.hpp"
#include "kernels/elastic/ellipticity.hpp"
#include "solver/base/error.hpp"
#include "solver/base/execution.hpp"
#include "solver/base/host_copy.hpp"
#include "solver/mechanics/equibiaxial.hpp"
#include "solver/mechanics/equilibrium_failure.hpp"
#include "solver/mechanics/linear/direct_solver.hpp"
#include "solver/mechanics/mesh.hpp"
#include "solver/mechanics/newton.hpp"
#include "solver/mechanics/rest_state.hpp"
#include "solver/mechanics/sparse_system.hpp"

namespace myowave::solver {
namespace {

constexpr double stress_unit = 10;  // kPa, the paper's edge load: the tolerance is relative to it

// Parts of a tension increment: the first of a ramp, and the smallest before it is given up.
constexpr double first_ramp_part = 1.0 / 4;
constexpr double least_ramp_part = 1.0 / 64;

elastic::Membrane membrane_of(const MechanicsSettings& settings) {
  elastic::Membrane membrane{.passive = settings, .load = {}};
  if (settings.edges == Edges::load) {
    (settings.load == Load::follower ? membrane.load.follower : membrane.load.dead) = settings.p;
  }
  return membrane;
}

}  // namespace

template <class ExecutionSpace>
struct Equilibrium<ExecutionSpace>::Impl {
  using Tension = GaussTension<MemorySpace>;

  elastic::ElementGrid grid;
  MechanicsSettings settings;
  elastic::Membrane membrane;
  Mesh mesh;
  DirectSolver solver;
  SparseSystem<ExecutionSpace> system;

  Nodes<MemorySpace> nodes;    // the last equilibrium, or the undeformed sheet
  Nodes<MemorySpace> start;    // where Newton starts: `nodes`, or the last part of a ramp
  Nodes<MemorySpace> current;  // of the iteration
  Nodes<MemorySpace> tried;
  Nodes<MemorySpace> direction;
  typename Nodes<MemorySpace>::host_mirror_type direction_host;
  elastic::Rows<MemorySpace> energy;  // and smallest J, by element
  typename elastic::Rows<MemorySpace>::host_mirror_type energy_host;

  Tension solved_Ta;  // of `nodes`; zero for the undeformed sheet
  Tension mixed_Ta;   // of a part of a ramp
  // The solver's last factor is of the tangent at `start`, under the tension of before.
  bool start_has_factor = false;
  // The last factor is of K + factor_shift L here.
  Nodes<MemorySpace> factor_nodes;
  Tension factor_Ta;
  double factor_shift = 0;
  bool in_equilibrium = false;  // false: `nodes` are undeformed

  Impl(const ExecutionSpace& space, const elastic::ElementGrid& grid_in, const MechanicsSettings& settings_in)
      : grid(grid_in),
        settings(settings_in),
        membrane(membrane_of(settings_in)),
        mesh(make_mesh(grid_in, settings_in.edges)),
        solver(mesh.row_begin, mesh.column),
        system(space, mesh),
        nodes("myowave::elastic::nodes", grid.nodes()),
        start("myowave::elastic::start_nodes", grid.nodes()),
        current("myowave::elastic::current_nodes", grid.nodes()),
        tried("myowave::elastic::tried_nodes", grid.nodes()),
        direction("myowave::elastic::direction", grid.nodes()),
        direction_host(Kokkos::create_mirror_view(direction)),
        energy("myowave::elastic::element_energy", 2, grid.elements()),
        energy_host(Kokkos::create_mirror_view(energy)),
        solved_Ta("myowave::elastic::solved_Ta", grid.elements()),
        mixed_Ta("myowave::elastic::mixed_Ta", grid.elements()),
        factor_nodes("myowave::elastic::factor_nodes", grid.nodes()),
        factor_Ta("myowave::elastic::factor_Ta", grid.elements()) {}

  template <class Archive>
  void state(Archive& archive) {
    archive(nodes, solved_Ta, in_equilibrium, start_has_factor, factor_nodes, factor_Ta, factor_shift);
  }

  // The sheet under one tension, as Newton sees it; see solver/mechanics/newton.hpp.
  struct Problem {
    Impl& sheet;
    const ExecutionSpace& space;
    const Tension& Ta;

    Evaluation evaluate() { return evaluate_at(sheet.current); }
    void linearize() { sheet.system.assemble(space, sheet.membrane, sheet.grid, sheet.current, Ta); }
    std::span<const double> residual() const { return sheet.system.residual(); }
    std::span<const double> tangent(double shift) { return sheet.system.tangent(shift); }
    void set_direction(std::span<const double> step) {
      sheet.system.scatter(step, sheet.direction_host);
      Kokkos::deep_copy(space, sheet.direction, sheet.direction_host);
    }
    Evaluation move(double length) {
      elastic::move_nodes(space, sheet.current, sheet.direction, length, sheet.tried);
      return evaluate_at(sheet.tried);
    }
    void accept() { std::swap(sheet.current, sheet.tried); }

    // The sum over the elements runs on the host: one order on every backend.
    Evaluation evaluate_at(const Nodes<MemorySpace>& positions) {
      elastic::element_energies(space, sheet.membrane, sheet.grid, positions, Ta, sheet.energy);
      Kokkos::deep_copy(space, sheet.energy_host, sheet.energy);
      space.fence("myowave::elastic::energy");
      Evaluation evaluation{.energy = 0, .min_J = sheet.energy_host(1, 0)};
      for (int e = 0; e < sheet.grid.elements(); ++e) {
        evaluation.energy += sheet.energy_host(0, e);
        evaluation.min_J = std::min(evaluation.min_J, sheet.energy_host(1, e));
      }
      return evaluation;
    }
  };

  // Where a solve starts: at the last equilibrium, else at the uniform one for the mean tension,
  // because from the undeformed sheet the load has all of its work still to do.
  void place_start(const ExecutionSpace& space, const Tension& Ta) {
    if (in_equilibrium || settings.edges == Edges::fixed) {
      Kokkos::deep_copy(space, start, nodes);
      return;
    }
    const auto Ta_host = host_copy(space, Ta);
    double sum = 0;
    for (int e = 0; e < grid.elements(); ++e) {
      for (int q = 0; q < elastic::gauss_points; ++q) sum += Ta_host(e, q);
    }
    const double mean_Ta = sum / (elastic::gauss_points * grid.elements());
    elastic::place_uniform(space, grid, equibiaxial_stretch(settings, mean_Ta).value_or(1), start);
  }

  // Newton from `start`, ending in `current`.
  bool converge(const ExecutionSpace& space, const Tension& Ta, Effort& effort) {
    Kokkos::deep_copy(space, current, start);
    Problem problem{*this, space, Ta};
    const double undeformed_energy = elastic::passive_energy(membrane.passive, 2, 1).w;  // kPa
    const NewtonSettings newton{.tolerance = settings.tolerance,
                                .residual_unit = stress_unit * grid.h,
                                .energy_unit = undeformed_energy * grid.elements() * grid.h * grid.h};
    effort.add(Newton(problem, solver, newton).minimise(start_has_factor));
    start_has_factor = effort.last.converged && (start_has_factor || effort.last.factorizations > 0);
    if (effort.last.converged && effort.last.factorizations > 0) {
      // The last factor led from here to `current`, which took its place.
      Kokkos::deep_copy(space, factor_nodes, tried);
      Kokkos::deep_copy(space, factor_Ta, Ta);
      factor_shift = effort.last.last_shift;
    }
    return effort.last.converged;
  }

  // From the tension of `nodes` to Ta in parts, halved where Newton fails.
  bool ramp(const ExecutionSpace& space, const Tension& Ta, Effort& effort) {
    effort.ramp_reached = 0;
    place_start(space, solved_Ta);
    double part = first_ramp_part;
    // Undeformed nodes are in no equilibrium: the ramp begins with the one without tension.
    double target = in_equilibrium ? part : 0;
    while (true) {
      elastic::mix_tension(space, solved_Ta, Ta, target, mixed_Ta);
      if (converge(space, mixed_Ta, effort)) {
        ++effort.ramp_steps;
        effort.ramp_reached = target;
        if (target == 1) return true;
        Kokkos::deep_copy(space, start, current);
      } else {
        part /= 2;
        if (target == 0 || part < least_ramp_part) return false;
      }
      target = std::min(1.0, effort.ramp_reached + part);
    }
  }

  // The pins hold the right neighbour of the middle node at its height, which it also has to the
  // left of it: after a large change of tension Newton can end in the sheet turned by 180 degrees.
  void turn_upright(const ExecutionSpace& space) {
    if (settings.edges == Edges::fixed) return;
    const int middle = middle_node(grid);
    const auto pins = host_copy(space, Kokkos::subview(current, std::pair(middle, middle + 2), Kokkos::ALL));
    if (pins(1, 0) >= pins(0, 0)) return;
    elastic::turn_around(space, middle, current);
    start_has_factor = false;
  }

  // Errors: NumericalFailure, always.
  [[noreturn]] void fail(const Tension& Ta, double time, const Effort& effort) const;
};

template <class ExecutionSpace>
void Equilibrium<ExecutionSpace>::Impl::fail(const Tension& Ta, double time, const Effort& effort) const {
  const auto Ta_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, Ta);
  const auto nodes_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, current);
  FailedState state{.time = time, .min_Ta = Ta_host(0, 0), .max_Ta = Ta_host(0, 0), .area = 0};
  for (int e = 0; e < grid.elements(); ++e) {
    const int row = e / grid.columns, column = e % grid.columns;
    for (int q = 0; q < elastic::gauss_points; ++q) {
      if (!std::isfinite(Ta_host(e, q))) {
        throw NumericalFailure(broken_tension_message(time, row, column));
      }
      state.min_Ta = std::min(state.min_Ta, Ta_host(e, q));
      state.max_Ta = std::max(state.max_Ta, Ta_host(e, q));
    }
    const auto element = elastic::element_nodes(grid, nodes_host, e);
    const double J = elastic::min_corner_J(element, grid.h);
    if (e == 0 || J < state.min_J) {
      state.min_J = J;
      state.row = row;
      state.column = column;
    }
    // J is linear in an element: its mean is the one at the centre.
    state.area += determinant(elastic::deformation_gradient(element, 0.5, 0.5, grid.h)) / grid.elements();
  }
  throw NumericalFailure(failure_message(settings, state, effort));
}

template <class ExecutionSpace>
Equilibrium<ExecutionSpace>::Equilibrium(const ExecutionSpace& space, const elastic::ElementGrid& grid,
                                         const MechanicsSettings& settings)
    : impl_(std::make_unique<Impl>(space, grid, settings)) {
  reset(space);
}
template <class ExecutionSpace>
Equilibrium<ExecutionSpace>::~Equilibrium() = default;
template <class ExecutionSpace>
Equilibrium<ExecutionSpace>::Equilibrium(Equilibrium&&) noexcept = default;
template <class ExecutionSpace>
Equilibrium<ExecutionSpace>& Equilibrium<ExecutionSpace>::operator=(Equilibrium&&) noexcept = default;

template <class ExecutionSpace>
SolveReport Equilibrium<ExecutionSpace>::solve(const ExecutionSpace& space,
                                               const GaussTension<MemorySpace>& Ta, double time) {
  if (const auto reason = why_no_rest_state(impl_->settings))
    throw NumericalFailure(no_rest_state_message(*reason, time));
  Effort effort;
  impl_->place_start(space, Ta);
  if (!impl_->converge(space, Ta, effort) && !impl_->ramp(space, Ta, effort)) impl_->fail(Ta, time, effort);
  impl_->turn_upright(space);
  Kokkos::deep_copy(space, impl_->nodes, impl_->current);
  Kokkos::deep_copy(space, impl_->solved_Ta, Ta);
  space.fence("myowave::elastic::solve");
  impl_->in_equilibrium = true;
  const int not_elliptic = elastic::count_not_elliptic(space, impl_->membrane, impl_->grid, impl_->nodes, Ta);
  return {.iterations = effort.iterations,
          .factorizations = effort.factorizations,
          .shifts = effort.shifts,
          .ramp_steps = effort.ramp_steps,
          .residual = effort.last.residual,
          .energy = effort.last.energy,
          .min_J = effort.last.min_J,
          .not_elliptic = not_elliptic,
          .time = effort.time};
}

template <class ExecutionSpace>
bool Equilibrium<ExecutionSpace>::is_solved_for(const ExecutionSpace& space,
                                                const GaussTension<MemorySpace>& Ta) const {
  return impl_->in_equilibrium && elastic::same_tension(space, impl_->solved_Ta, Ta);
}

template <class ExecutionSpace>
const Nodes<typename ExecutionSpace::memory_space>& Equilibrium<ExecutionSpace>::nodes() const {
  return impl_->nodes;
}

template <class ExecutionSpace>
void Equilibrium<ExecutionSpace>::reset(const ExecutionSpace& space) {
  elastic::place_uniform(space, impl_->grid, 1, impl_->nodes);
  Kokkos::deep_copy(space, impl_->solved_Ta, 0.0);
  space.fence("myowave::elastic::reset");
  impl_->in_equilibrium = false;
  impl_->start_has_factor = false;
}

template <class ExecutionSpace>
const elastic::ElementGrid& Equilibrium<ExecutionSpace>::grid() const {
  return impl_->grid;
}

template <class ExecutionSpace>
void Equilibrium<ExecutionSpace>::save(StateWriter& writer) const {
  writer(*impl_);
}

template <class ExecutionSpace>
void Equilibrium<ExecutionSpace>::load(const ExecutionSpace& space, StateReader& reader) {
  reader(*impl_);
  if (!impl_->start_has_factor) return;
  impl_->system.assemble(space, impl_->membrane, impl_->grid, impl_->factor_nodes, impl_->factor_Ta);
  impl_->solver.factorize(impl_->system.tangent(impl_->factor_shift));
}

template class Equilibrium<Kokkos::DefaultHostExecutionSpace>;
// A run solves on the host; the benchmarks and tests also on a device, where there is one.
#ifdef MYOWAVE_HAS_DEVICE
template class Equilibrium<Kokkos::DefaultExecutionSpace>;
#endif
#ifdef MYOWAVE_HAS_SERIAL_TOO
template class Equilibrium<Kokkos::Serial>;
#endif

}  // namespace myowave::solver
