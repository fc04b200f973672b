// Steps on a tile with the metric from the element nodes, for the device compilers.
#include "kernels/transfer/metric_rows.hpp"

#include "kernels/tissue/tiled_step.hpp"
#include "solver/select_model.hpp"

namespace myowave {

using Space = Kokkos::DefaultExecutionSpace::memory_space;

template <class Real, class View = EnsembleField<Real, Space>>
void steps(const transfer::DeformedDiffusion<Real, Space>& diffusion, tissue::ExcitationFields<View>& state,
           tissue::ExcitationFields<View>& spare) {
  tissue::tiled_steps(Kokkos::DefaultExecutionSpace(), diffusion, solver::make_model<Real>({}, {}), 0.02, 80,
                      state, spare);
}

template void steps<double>(const transfer::DeformedDiffusion<double, Space>&,
                            tissue::ExcitationFields<EnsembleField<double, Space>>&,
                            tissue::ExcitationFields<EnsembleField<double, Space>>&);
template void steps<float>(const transfer::DeformedDiffusion<float, Space>&,
                           tissue::ExcitationFields<EnsembleField<float, Space>>&,
                           tissue::ExcitationFields<EnsembleField<float, Space>>&);

}  // namespace myowave
