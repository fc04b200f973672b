// One explicit Euler step of the monodomain equations with active tension (Eqs 22a-c):
//   V += dt (D diffusion(V) + f(V, r)) / C_m,   r += dt r_t,   Ta += dt Ta_t,
// all three from the old state. r and Ta depend on their own node alone and are updated in place.
//
//   view    shape                      unit           access
//   V       (members, rows, columns)   -              read
//   V_next  (members, rows, columns)   -              write
//   r       (members, rows, columns)   -              read and write
//   Ta      (members, rows, columns)   kPa            read and write
#pragma once

#include "kernels/base/row_loop.hpp"
#include "kernels/tissue/diffusion.hpp"
#include "kernels/tissue/stimulus.hpp"

namespace myowave::tissue {

// Any cell and tension model with the functions of AlievPanfilov and ActiveTension will do: the
// model is a template parameter, so that tissue/ does not depend on one.
template <class Cell, class Tension>
struct MonodomainModel {
  using Real = decltype(Cell{}.k);
  Cell cell;
  Tension tension;
  Real D = 1;            // conductivity, length^2/t.u.
  Real inverse_C_m = 1;  // 1 / membrane capacitance
};

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
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, first, last), [&](int i) { update_row(team, m, i); });
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION void update_row(const TeamMember& team, int m, int i) const {
    const int columns = diffusion.grid.columns;
    const auto update = Update{model, dt, &V(m, i, 0), &V_next(m, i, 0), &r(m, i, 0), &Ta(m, i, 0)};
    if (diffusion.row_is_regular(i)) {
      const auto row = diffusion.row(V, m, i);
      for_columns(team, 1, columns - 1, [=](int j) { update(j, row(j - 1, j, j + 1)); });
      Kokkos::single(Kokkos::PerThread(team), [&]() {
        update(0, diffusion.at(V, m, i, 0));
        update(columns - 1, diffusion.at(V, m, i, columns - 1));
      });
    } else {
      for_columns(team, 0, columns, [&](int j) { update(j, diffusion.at(V, m, i, j)); });
    }
  }

  struct Update {
    Model model;
    Real dt;
    const Real* KOKKOS_RESTRICT V;
    Real* KOKKOS_RESTRICT V_next;
    Real* KOKKOS_RESTRICT r;
    Real* KOKKOS_RESTRICT Ta;
    KOKKOS_FORCEINLINE_FUNCTION void operator()(int j, Real diffused) const {
      const Real V_old = V[j], r_old = r[j], Ta_old = Ta[j];
      V_next[j] = V_old + dt * model.inverse_C_m * (model.D * diffused + model.cell.excitation(V_old, r_old));
      r[j] = r_old + dt * model.cell.recovery(V_old, r_old);
      Ta[j] = Ta_old + dt * model.tension.rate(V_old, Ta_old);
    }
  };
};

// Launches one step; no fence, no allocation. Stimuli are added to V_next afterwards (add_stimulus).
template <class ExecutionSpace, class Diffusion, class Model, class View>
void monodomain_step(const ExecutionSpace& space, const Diffusion& diffusion, const Model& model, double dt,
                     const View& V, const View& r, const View& Ta, const View& V_next) {
  using Step = MonodomainStep<ExecutionSpace, Diffusion, Model>;
  // A device team takes a few rows with a warp of columns each; on a host a team is one thread.
  constexpr int rows_per_team = 4;
  constexpr int vector_length = 32;
  const int members = static_cast<int>(V.extent(0));
  const int teams_per_member = (diffusion.grid.rows + rows_per_team - 1) / rows_per_team;
  const Step step{diffusion,     model,           typename Diffusion::Scalar(dt), V, V_next, r, Ta,
                  rows_per_team, teams_per_member};
  constexpr bool on_host = Kokkos::SpaceAccessibility<ExecutionSpace, Kokkos::HostSpace>::accessible;
  Kokkos::parallel_for("myowave::tissue::monodomain_step",
                       typename Step::Policy(space, members * teams_per_member, on_host ? 1 : rows_per_team,
                                             on_host ? 1 : vector_length),
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
