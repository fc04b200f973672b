// The form of the diffusion term of a scene as a compile-time kernel variant, with the transfer that updates
// its metric. The list makes the variants that are instantiated, tested and benchmarked.
#pragma once

#include <cstdint>
#include <variant>

#include "kernels/tissue/tiled_step.hpp"
#include "kernels/transfer/deformation_to_grid.hpp"
#include "solver/excitation/select_model.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

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

}  // namespace myowave::solver
