// Electromechanics in single precision.
#include "solver/coupling/electromechanics_sampling.hpp"
#include "solver/coupling/electromechanics_solving.hpp"
#include "solver/coupling/electromechanics_stepping.hpp"

namespace myowave::solver {

template class Electromechanics<Kokkos::DefaultExecutionSpace, float>;
#ifdef MYOWAVE_HAS_DEVICE
template class Electromechanics<Kokkos::DefaultHostExecutionSpace, float>;
#endif
#ifdef MYOWAVE_HAS_SERIAL_TOO
template class Electromechanics<Kokkos::Serial, float>;
#endif

}  // namespace myowave::solver
