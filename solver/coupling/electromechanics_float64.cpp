// Electromechanics in double precision.
#include "solver/coupling/electromechanics_sampling.hpp"
#include "solver/coupling/electromechanics_solving.hpp"
#include "solver/coupling/electromechanics_stepping.hpp"

namespace myowave::solver {

template class Electromechanics<Kokkos::DefaultExecutionSpace, double>;
#ifdef MYOWAVE_HAS_DEVICE
template class Electromechanics<Kokkos::DefaultHostExecutionSpace, double>;
#endif
#ifdef MYOWAVE_HAS_SERIAL_TOO
template class Electromechanics<Kokkos::Serial, double>;
#endif

}  // namespace myowave::solver
