// The only place where a run-time choice becomes a compile-time kernel variant. The lists below make
// the variants that are instantiated, tested and benchmarked.
#pragma once

#include <type_traits>
#include <variant>

#include "kernels/cell/active_tension.hpp"
#include "kernels/cell/aliev_panfilov.hpp"
#include "kernels/tissue/monodomain_step.hpp"
#include "kernels/tissue/tiled_step.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "solver/scene.hpp"

namespace myowave::solver {

template <class Real, class Scheme = tissue::ForwardEuler>
using Model = tissue::MonodomainModel<cell::AlievPanfilov<Real>, cell::ActiveTension<Real>, Scheme>;

// Where nothing asks for Ta.
template <class Real, class Scheme = tissue::ForwardEuler>
using ModelWithoutTension = tissue::MonodomainModel<cell::AlievPanfilov<Real>, cell::NoTension, Scheme>;

// The stencil whose error a scheme's takes away.
template <class Scheme>
inline constexpr tissue::Stencil stencil_of =
    std::is_same_v<Scheme, tissue::SplitStep> ? tissue::Stencil::nine_point : tissue::Stencil::five_point;

// One form of the diffusion term and the scheme that takes its steps, with what refreshes its metric.
template <class ExecutionSpace, class Real>
struct ModelForms {
  using Space = typename ExecutionSpace::memory_space;
  template <class TimeScheme>
  struct Identity {
    using Scheme = TimeScheme;
    tissue::IdentityDiffusion<Real, Space, stencil_of<Scheme>> diffusion;
  };
  struct Conservative {
    using Scheme = tissue::ForwardEuler;
    tissue::ConservativeDiffusion<Real, Space> diffusion;
    transfer::ConservativeTransfer<ExecutionSpace, Real> transfer;
  };
  struct ConservativeSplit {
    using Scheme = tissue::SplitStep;
    tissue::ConservativeDiffusion<Real, Space, stencil_of<Scheme>> diffusion;
    transfer::ConservativeTransfer<ExecutionSpace, Real, stencil_of<Scheme>> transfer;
  };
  struct Expanded {
    using Scheme = tissue::ForwardEuler;
    tissue::ExpandedDiffusion<Real, Space> diffusion;
    transfer::ExpandedTransfer<ExecutionSpace, Real> transfer;
  };
  using Any = std::variant<Identity<tissue::ForwardEuler>, Identity<tissue::SplitStep>, Conservative,
                           ConservativeSplit, Expanded>;
};

template <class ExecutionSpace, class Real>
typename ModelForms<ExecutionSpace, Real>::Any select_form(MetricForm form, const tissue::Grid& grid,
                                                           const elastic::ElementGrid& elements,
                                                           int cells_per_element,
                                                           Scheme scheme = Scheme::euler) {
  using Forms = ModelForms<ExecutionSpace, Real>;
  using Space = typename Forms::Space;
  const auto identity = [&]<class TimeScheme>(TimeScheme) {
    return typename Forms::template Identity<TimeScheme>{
        tissue::IdentityDiffusion<Real, Space, stencil_of<TimeScheme>>(grid)};
  };
  switch (form) {
    case MetricForm::conservative:
      if (scheme == Scheme::split)
        return typename Forms::ConservativeSplit{
            {grid, tissue::ConservativeMetric<Real, Space, stencil_of<tissue::SplitStep>>(1, grid)},
            {grid, elements, cells_per_element}};
      return typename Forms::Conservative{{grid, tissue::ConservativeMetric<Real, Space>(1, grid)},
                                          {grid, elements, cells_per_element}};
    case MetricForm::expanded:
      return typename Forms::Expanded{{grid, tissue::ExpandedMetric<Real, Space>(1, grid)},
                                      {grid, elements, cells_per_element}};
    case MetricForm::none:
      break;
  }
  if (scheme == Scheme::split) return identity(tissue::SplitStep{});
  return identity(tissue::ForwardEuler{});
}

template <class Real>
Model<Real> make_model(const ExcitationSettings& e, const TensionSettings& t) {
  return {{Real(e.k), Real(e.a), Real(e.b), Real(e.eps), Real(e.mu1), Real(e.mu2)},
          {Real(t.k_Ta), Real(t.eps_below), Real(t.eps_above), Real(t.threshold)},
          Real(e.D),
          Real(1 / e.C_m)};
}

// The same that takes its steps by another scheme.
template <class Scheme, class Real>
Model<Real, Scheme> in_scheme(const Model<Real>& model) {
  return {model.cell, model.tension, model.D, model.inverse_C_m};
}
template <class Scheme, class Real>
ModelWithoutTension<Real, Scheme> without_tension(const Model<Real>& model) {
  return {model.cell, {}, model.D, model.inverse_C_m};
}

// action(model), by a scheme, with Ta or without.
template <class Scheme, class Real, class Action>
void with_model(const Scene& scene, const Model<Real>& model, const Action& action) {
  if (has_tension(scene))
    action(in_scheme<Scheme>(model));
  else
    action(without_tension<Scheme>(model));
}

}  // namespace myowave::solver
