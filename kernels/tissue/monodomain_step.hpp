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
  using TeamMember = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  static_assert(std::is_same_v<typename Diffusion::Space, MemorySpace>, "coefficients in another memory");

  // Fields that stay in the caches of an EPYC; between this and 16 MiB hints to fetch make no difference
  // there.
  static constexpr std::size_t cached_bytes = 8 * 1024 * 1024;

  Diffusion diffusion;
  Model model;
  Real dt;
  ConstView V;
  View V_next, r, Ta;
  int rows_per_block;
  int blocks_per_member;
  bool from_memory;  // or from a host's caches

  // A block of rows by one thread of a host.
  KOKKOS_FUNCTION void operator()(int block) const {
    for (int i = first_row(block); i < last_row(block); ++i)
      advance_row(HostColumns<Real>{from_memory}, block / blocks_per_member, i);
  }

  // A block by a device's team, a row by each of its threads.
  KOKKOS_FUNCTION void operator()(const TeamMember& team) const {
    const int block = team.league_rank();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, first_row(block), last_row(block)), [&](int i) {
      advance_row(ThreadColumns<TeamMember>{team}, block / blocks_per_member, i);
    });
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION int first_row(int block) const {
    return block % blocks_per_member * rows_per_block;
  }
  KOKKOS_FORCEINLINE_FUNCTION int last_row(int block) const {
    return Kokkos::min(first_row(block) + rows_per_block, diffusion.grid.rows);
  }

  template <class Columns>
  KOKKOS_FORCEINLINE_FUNCTION void advance_row(const Columns& lanes, int m, int i) const {
    const int columns = diffusion.grid.columns;
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
  const int members = static_cast<int>(V.extent(0)), rows = diffusion.grid.rows;
  // A team takes a few rows with a warp of columns each. A thread of a host takes its share of the rows at
  // once: a range of blocks starts faster than a league of teams.
  constexpr int rows_of_team = 4, warp = 32;
  const int wanted = runs_on_host<ExecutionSpace> ? Kokkos::min(rows, tiles_of(space.concurrency(), members))
                                                  : tiles_of(rows, rows_of_team);
  const int rows_per_block = tiles_of(rows, wanted), blocks_per_member = tiles_of(rows, rows_per_block);
  const int blocks = members * blocks_per_member;
  const bool from_memory =
      (2 * V.span() + r.span() + Ta.span()) * sizeof(typename Step::Real) > Step::cached_bytes;
  const Step step{diffusion, model,          typename Step::Real(dt), V,          V_next, r,
                  Ta,        rows_per_block, blocks_per_member,       from_memory};
  constexpr auto label = "myowave::tissue::monodomain_step";
  if constexpr (runs_on_host<ExecutionSpace>)
    Kokkos::parallel_for(label, Kokkos::RangePolicy<ExecutionSpace>(space, 0, blocks), step);
  else
    Kokkos::parallel_for(label, Kokkos::TeamPolicy<ExecutionSpace>(space, blocks, rows_of_team, warp), step);
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

  KOKKOS_FORCEINLINE_FUNCTION Real operator()(int m, int i, int j) const {
    double current = 0;
    for (std::size_t s = 0; s < stimuli.extent(0); ++s)
      if (stimuli(s).region.contains(i, j)) current += stimuli(s).amplitude;
    return model.inverse_C_m * (model.D * diffusion.at(V, m, i, j) +
                                model.cell.excitation(V(m, i, j), r(m, i, j)) + Real(current));
  }
};

}  // namespace myowave::tissue
