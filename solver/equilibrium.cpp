#include "solver/equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kernels/elastic/assemble.hpp"
#include "solver/direct_solver.hpp"
#include "solver/error.hpp"
#include "solver/mesh.hpp"
#include "solver/newton.hpp"
#include "solver/sparse_system.hpp"

namespace myowave::solver {
namespace {

constexpr double stress_unit = 10;  // kPa, the paper's edge load: the tolerance is relative to it

// Parts of a tension increment: the first of a ramp, and the smallest before it is given up.
constexpr double first_ramp_part = 1.0 / 4;
constexpr double least_ramp_part = 1.0 / 64;

elastic::Membrane membrane_of(const MechanicsSettings& settings) {
  elastic::Membrane membrane{.passive = {.c1 = settings.c1, .c2 = settings.c2}, .load = {}};
  if (settings.edges == Edges::load) {
    (settings.load == Load::follower ? membrane.load.follower : membrane.load.dead) = settings.p;
  }
  return membrane;
}

// What was done in one solve, for its report and for the message of its failure.
struct Effort {
  std::int64_t iterations = 0, factorizations = 0, shifts = 0, halvings = 0, ramp_steps = 0;
  double largest_shift = 0;  // kPa
  double ramp_reached = -1;  // fraction of the tension; < 0: no ramp was tried
  NewtonReport last;

  void add(const NewtonReport& report) {
    iterations += report.iterations;
    factorizations += report.factorizations;
    shifts += report.shifts;
    halvings += report.halvings;
    largest_shift = std::max(largest_shift, report.largest_shift);
    last = report;
  }
};

}  // namespace

template <class ExecutionSpace>
struct Equilibrium<ExecutionSpace>::Impl {
  using HostNodes = typename Nodes<MemorySpace>::host_mirror_type;

  elastic::ElementGrid grid;
  MechanicsSettings settings;
  elastic::Membrane membrane;
  Mesh mesh;
  DirectSolver solver;
  SparseSystem<ExecutionSpace> system;

  Nodes<MemorySpace> nodes;    // the last equilibrium, or the undeformed sheet
  Nodes<MemorySpace> current;  // of the iteration
  Nodes<MemorySpace> tried;
  Nodes<MemorySpace> ramped;  // the last equilibrium of a ramp
  Nodes<MemorySpace> direction;
  HostNodes direction_host;
  elastic::Numbers<MemorySpace> energy;  // by element
  typename elastic::Numbers<MemorySpace>::host_mirror_type energy_host;

  GaussTension<MemorySpace> solved_Ta;  // of `nodes`; zero for the undeformed sheet
  GaussTension<MemorySpace> mixed_Ta;   // of a part of a ramp
  bool in_equilibrium = false;          // false: `nodes` are undeformed

  Impl(const ExecutionSpace& space, const elastic::ElementGrid& grid_in, const MechanicsSettings& settings_in)
      : grid(grid_in),
        settings(settings_in),
        membrane(membrane_of(settings_in)),
        mesh(make_mesh(grid_in, settings_in.edges)),
        solver(mesh.row_begin, mesh.column),
        system(space, mesh),
        nodes("myowave::elastic::nodes", grid.nodes()),
        current("myowave::elastic::current_nodes", grid.nodes()),
        tried("myowave::elastic::tried_nodes", grid.nodes()),
        ramped("myowave::elastic::ramped_nodes", grid.nodes()),
        direction("myowave::elastic::direction", grid.nodes()),
        direction_host(Kokkos::create_mirror_view(direction)),
        energy("myowave::elastic::element_energy", grid.elements()),
        energy_host(Kokkos::create_mirror_view(energy)),
        solved_Ta("myowave::elastic::solved_Ta", grid.elements()),
        mixed_Ta("myowave::elastic::mixed_Ta", grid.elements()) {}

  // Newton's view of the sheet under one tension; see solver/newton.hpp.
  struct Problem {
    Impl& sheet;
    const ExecutionSpace& space;
    const GaussTension<MemorySpace>& Ta;

    Trial evaluate() { return trial_at(sheet.current); }
    void linearize() { sheet.system.assemble(space, sheet.membrane, sheet.grid, sheet.current, Ta); }
    std::span<const double> residual() const { return sheet.system.residual(); }
    std::span<const double> tangent() const { return sheet.system.tangent(); }
    Trial move(std::span<const double> step, double length) {
      if (length == 1) {
        sheet.system.scatter(step, sheet.direction_host);
        Kokkos::deep_copy(space, sheet.direction, sheet.direction_host);
      }
      elastic::move_nodes(space, sheet.current, sheet.direction, length, sheet.tried);
      return trial_at(sheet.tried);
    }
    void accept() { std::swap(sheet.current, sheet.tried); }

    // The sum over the elements runs on the host: one order on every backend.
    Trial trial_at(const Nodes<MemorySpace>& positions) {
      Trial trial;
      trial.min_J = elastic::element_energies(space, sheet.membrane, sheet.grid, positions, Ta, sheet.energy);
      Kokkos::deep_copy(space, sheet.energy_host, sheet.energy);
      space.fence("myowave::elastic::energy");
      for (std::size_t e = 0; e < sheet.energy_host.extent(0); ++e) trial.energy += sheet.energy_host(e);
      return trial;
    }
  };

  // Newton from `start`, ending in `current`.
  bool converge(const ExecutionSpace& space, const Nodes<MemorySpace>& start,
                const GaussTension<MemorySpace>& Ta, Effort& effort) {
    Kokkos::deep_copy(space, current, start);
    Problem problem{*this, space, Ta};
    const NewtonSettings newton{.tolerance = settings.tolerance, .residual_unit = stress_unit * grid.h};
    effort.add(Newton(problem, solver, newton).minimise());
    return effort.last.converged;
  }

  // From the tension of `nodes` to Ta in parts, halved where Newton fails.
  bool ramp(const ExecutionSpace& space, const GaussTension<MemorySpace>& Ta, Effort& effort) {
    effort.ramp_reached = 0;
    Kokkos::deep_copy(space, ramped, nodes);
    double part = first_ramp_part;
    // Undeformed nodes are in no equilibrium: the ramp begins with the one without tension.
    double target = in_equilibrium ? part : 0;
    while (true) {
      elastic::mix_tension(space, solved_Ta, Ta, target, mixed_Ta);
      if (converge(space, ramped, mixed_Ta, effort)) {
        ++effort.ramp_steps;
        effort.ramp_reached = target;
        if (target == 1) return true;
        Kokkos::deep_copy(space, ramped, current);
      } else {
        part /= 2;
        if (target == 0 || part < least_ramp_part) return false;
      }
      target = std::min(1.0, effort.ramp_reached + part);
    }
  }

  [[noreturn]] void fail(const ExecutionSpace& space, const GaussTension<MemorySpace>& Ta, double time,
                         const Effort& effort) const;
};

namespace {

// Smallest corner J, where it is, and the area over the undeformed one.
struct Deformation {
  double min_J = 0;
  int row = 0, column = 0;
  double area = 0;
};

template <class HostNodes>
Deformation deformation_of(const elastic::ElementGrid& grid, const HostNodes& nodes) {
  Deformation found;
  for (int e = 0; e < grid.elements(); ++e) {
    const auto element = elastic::element_nodes(grid, nodes, e);
    const double J = elastic::min_corner_J(element, grid.h);
    if (e == 0 || J < found.min_J) {
      found.min_J = J;
      found.row = e / grid.columns;
      found.column = e % grid.columns;
    }
    found.area += determinant(elastic::deformation_gradient(element, 0.5, 0.5, grid.h)) / grid.elements();
  }
  return found;
}

std::string what_was_tried(const Effort& effort) {
  std::string text = fmt::format("{} Newton iterations, {} halvings of a step, {} shifts", effort.iterations,
                                 effort.halvings, effort.shifts);
  if (effort.shifts > 0) text += fmt::format(" (largest {:.3g} kPa)", effort.largest_shift);
  if (effort.ramp_reached >= 0) {
    text += fmt::format(", and a ramp of the tension that stopped at {:.0f} % after {} parts",
                        100 * effort.ramp_reached, effort.ramp_steps);
  }
  return text;
}

std::string what_to_do(const MechanicsSettings& settings, const Deformation& found, double max_Ta) {
  constexpr double runaway_area = 50;      // the paper's load alone stretches to 1.28
  constexpr double elliptic_tension = 60;  // kPa; an equibiaxial state stays elliptic up to it
  if (settings.edges == Edges::load && settings.p > 0 && found.area > runaway_area) {
    return fmt::format(
        "The sheet grows without bound, so that p = {:g} kN/m may have no equilibrium with c1 = {:g}, c2 = "
        "{:g} "
        "kPa: lower mechanics.p or raise mechanics.c1 and c2",
        settings.p, settings.c1, settings.c2);
  }
  if (max_Ta > elliptic_tension) {
    return fmt::format(
        "The tension is above {:g} kPa, where the sheet can lose ellipticity: lower tension.k_Ta, raise "
        "mechanics.c1 and c2, or shorten mechanics.interval",
        elliptic_tension);
  }
  return "Shorten mechanics.interval, so that the tension changes less between solves; if that does not "
         "help, "
         "bring mechanics.p, c1 and c2 nearer to the paper's 10 kN/m, 2 and 6 kPa";
}

}  // namespace

template <class ExecutionSpace>
void Equilibrium<ExecutionSpace>::Impl::fail(const ExecutionSpace& space, const GaussTension<MemorySpace>& Ta,
                                             double time, const Effort& effort) const {
  const auto Ta_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, Ta);
  const auto nodes_host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, current);
  space.fence("myowave::elastic::failure");
  double min_Ta = Ta_host(0, 0), max_Ta = min_Ta;
  for (int e = 0; e < grid.elements(); ++e) {
    for (int q = 0; q < elastic::gauss_points; ++q) {
      if (!std::isfinite(Ta_host(e, q))) {
        throw NumericalFailure(
            fmt::format("mechanics at t = {:g} t.u.: the active tension is not finite in element (row {}, "
                        "column {}); the "
                        "excitation has blown up: lower time.dt",
                        time, e / grid.columns, e % grid.columns));
      }
      min_Ta = std::min(min_Ta, Ta_host(e, q));
      max_Ta = std::max(max_Ta, Ta_host(e, q));
    }
  }
  const Deformation found = deformation_of(grid, nodes_host);
  throw NumericalFailure(
      fmt::format("mechanics at t = {:g} t.u.: no equilibrium found for an active tension of {:.4g} to "
                  "{:.4g} kPa, p = {:g} "
                  "kN/m, c1 = {:g}, c2 = {:g} kPa. Tried: {}. Reached: residual {:.3g} (wanted {:.3g}), area "
                  "{:.4g} of the "
                  "undeformed one, smallest J {:.3g} in element (row {}, column {}). {}.",
                  time, min_Ta, max_Ta, settings.edges == Edges::load ? settings.p : 0.0, settings.c1,
                  settings.c2, what_was_tried(effort), effort.last.residual, settings.tolerance, found.area,
                  found.min_J, found.row, found.column, what_to_do(settings, found, max_Ta)));
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
  Effort effort;
  if (!impl_->converge(space, impl_->nodes, Ta, effort) && !impl_->ramp(space, Ta, effort)) {
    impl_->fail(space, Ta, time, effort);
  }
  Kokkos::deep_copy(space, impl_->nodes, impl_->current);
  Kokkos::deep_copy(space, impl_->solved_Ta, Ta);
  space.fence("myowave::elastic::solve");
  impl_->in_equilibrium = true;
  return {.iterations = effort.iterations,
          .factorizations = effort.factorizations,
          .shifts = effort.shifts,
          .ramp_steps = effort.ramp_steps,
          .residual = effort.last.residual,
          .energy = effort.last.energy,
          .min_J = effort.last.min_J};
}

template <class ExecutionSpace>
const Nodes<typename ExecutionSpace::memory_space>& Equilibrium<ExecutionSpace>::nodes() const {
  return impl_->nodes;
}

template <class ExecutionSpace>
void Equilibrium<ExecutionSpace>::reset(const ExecutionSpace& space) {
  elastic::place_undeformed(space, impl_->grid, impl_->nodes);
  Kokkos::deep_copy(space, impl_->solved_Ta, 0.0);
  space.fence("myowave::elastic::reset");
  impl_->in_equilibrium = false;
}

template <class ExecutionSpace>
const elastic::ElementGrid& Equilibrium<ExecutionSpace>::grid() const {
  return impl_->grid;
}

template class Equilibrium<Kokkos::DefaultExecutionSpace>;

}  // namespace myowave::solver
