// One explicit step of the whole sheet (row_update.hpp); r and Ta depend on their own node alone and are
// updated in place.
//
//   view    shape                      unit           access
//   V       (members, rows, columns)   -              read
//   V_next  (members, rows, columns)   -              write
//   r       (members, rows, columns)   -              read and write
//   Ta      (members, rows, columns)   kPa            read and write
#pragma once

#include "kernels/tissue/row_update.hpp"
#include "kernels/tissue/stimulus.hpp"

namespace myowave::tissue {

template <class ExecutionSpace, class Diffusion, class Model>
struct MonodomainStep {
  using Real = typename Diffusion::Scalar;
  using MemorySpace = typename ExecutionSpace::memory_space;
  using View = EnsembleField<Real, MemorySpace>;
  using ConstView = EnsembleField<const Real, MemorySpace>;
  using Policy = Kokkos::TeamPolicy<ExecutionSpace>;
  using TeamMember = typename Policy::member_type;
  static_assert(std::is_same_v<typename Diffusion::Space, MemorySpace>, "coefficients in another memory");

  Diffusion diffusion;
  Model model;
  Real dt;
  ConstView V;
  View V_next, r, Ta;
  int rows_per_team;
  int teams_per_member;

  KOKKOS_FUNCTION void operator()(const TeamMember& team) const {
    const int m = team.league_rank() / teams_per_member;
    const int first = (team.league_rank() % teams_per_member) * rows_per_team;
    const int last = Kokkos::min(first + rows_per_team, diffusion.grid.rows);
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, first, last), [&](int i) { advance_row(team, m, i); });
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION void advance_row(const TeamMember& team, int m, int i) const {
    const int columns = diffusion.grid.columns;
    const ThreadColumns<TeamMember> lanes{team};
    Real* const tension = Model::has_tension ? &Ta(m, i, 0) : nullptr;
    const NodeUpdate<Model> update{model,       dt,     &V(m, i, 0), &r(m, i, 0), tension, &V_next(m, i, 0),
                                   &r(m, i, 0), tension};
    const auto at = [&](int j) { update(j, diffusion.at(V, m, i, j)); };
    const auto rows = rows_of(V, diffusion.grid, m, i);
    if constexpr (Diffusion::mirrored_edges) {
      update_row(lanes, 0, columns, columns, diffusion.row(rows, m, i, 0), update);
    } else if (i > 0 && i < diffusion.grid.rows - 1) {
      update_row(lanes, 1, columns - 1, columns, diffusion.row(rows, m, i, 0), update);
      lanes.once([&]() { at(0), at(columns - 1); });
    } else {
      lanes.each(0, columns, at);
    }
  }
};

// Launches one step; no fence, no allocation. Stimuli are added to V_next afterwards (add_stimulus).
template <class ExecutionSpace, class Diffusion, class Model, class View>
void monodomain_step(const ExecutionSpace& space, const Diffusion& diffusion, const Model& model, double dt,
                     const View& V, const View& r, const View& Ta, const View& V_next) {
  using Step = MonodomainStep<ExecutionSpace, Diffusion, Model>;
  constexpr bool on_host = Kokkos::SpaceAccessibility<ExecutionSpace, Kokkos::HostSpace>::accessible;
  const int members = static_cast<int>(V.extent(0)), rows = diffusion.grid.rows;
  // A device team takes a few rows with a warp of columns each. On a host a team is one thread, which takes
  // its share of the rows at once.
  constexpr int rows_of_device_team = 4, warp = 32;
  const int teams = on_host ? Kokkos::min(rows, tiles_of(space.concurrency(), members))
                            : tiles_of(rows, rows_of_device_team);
  const int rows_per_team = tiles_of(rows, teams), teams_per_member = tiles_of(rows, rows_per_team);
  const Step step{diffusion,     model,           typename Diffusion::Scalar(dt), V, V_next, r, Ta,
                  rows_per_team, teams_per_member};
  Kokkos::parallel_for("myowave::tissue::monodomain_step",
                       typename Step::Policy(space, members * teams_per_member,
                                             on_host ? 1 : rows_of_device_team, on_host ? 1 : warp),
                       step);
}

// dV/dt, the full right-hand side of Eq 22a, at one node.
template <class Diffusion, class Model>
struct MonodomainRate {
  using Real = typename Diffusion::Scalar;
  using ConstView = typename Diffusion::ConstView;
  Diffusion diffusion;
  Model model;
  ConstView V, r;
  Kokkos::View<const ActiveStimulus*, typename Diffusion::Space> stimuli;  // those on at this instant

  KOKKOS_FUNCTION Real operator()(int m, int i, int j) const {
    double current = 0;
    for (std::size_t s = 0; s < stimuli.extent(0); ++s)
      if (stimuli(s).region.contains(i, j)) current += stimuli(s).amplitude;
    return model.inverse_C_m * (model.D * diffusion.at(V, m, i, j) +
                                model.cell.excitation(V(m, i, j), r(m, i, j)) + Real(current));
  }
};

}  // namespace myowave::tissue
