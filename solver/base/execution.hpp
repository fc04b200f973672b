// Where a run computes. Kernels of two threads of the program may go on at once where their instances differ.
#pragma once

#include <Kokkos_Core.hpp>
#include <optional>
#include <type_traits>

#include "kernels/base/row_loop.hpp"

// Every execution space of the build has its instantiations: Kokkos::DefaultExecutionSpace,
// where that is a device's Kokkos::DefaultHostExecutionSpace too, and where that is not Serial but there is
// one, Kokkos::Serial.
#if defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL)
#define MYOWAVE_HAS_DEVICE
#endif
#if defined(KOKKOS_ENABLE_SERIAL) && (defined(KOKKOS_ENABLE_OPENMP) || defined(KOKKOS_ENABLE_THREADS))
#define MYOWAVE_HAS_SERIAL_TOO
#endif

namespace myowave::solver {

// The mechanics is the host's: on its default space beside a device, else where the excitation is.
template <class ExecutionSpace>
using HostOf =
    std::conditional_t<runs_on_host<ExecutionSpace>, ExecutionSpace, Kokkos::DefaultHostExecutionSpace>;

template <class ExecutionSpace>
struct ExecutionOn {
  ExecutionSpace device{};        // the excitation
  HostOf<ExecutionSpace> host{};  // the mechanics
};
using Execution = ExecutionOn<Kokkos::DefaultExecutionSpace>;

// The choices below stand in templates: only there is the branch that does not fit the backend left out.

// A host instance beside the default one. Empty where the backend has a single one, or a single core for
// everything.
template <class Host = Kokkos::DefaultHostExecutionSpace>
std::optional<Host> own_host_instance([[maybe_unused]] int threads) {
#ifdef KOKKOS_ENABLE_OPENMP
  if constexpr (std::is_same_v<Host, Kokkos::OpenMP>) return Host(threads);
#endif
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<Host, Kokkos::Serial>) return Host(Kokkos::NewInstance{});
#endif
  return std::nullopt;
}

// The host instance itself where the excitation runs there too, else a queue (stream) of its own, so that the
// kernels of several small sheets fill the device together.
template <class Device = Kokkos::DefaultExecutionSpace>
Device own_device_instance(const Kokkos::DefaultHostExecutionSpace& host) {
  if constexpr (std::is_same_v<Device, Kokkos::DefaultHostExecutionSpace>)
    return host;
  else
    return Kokkos::Experimental::partition_space(Device(), 1)[0];
}

// Instances of one thread of the program, with so many host threads. Empty as above.
inline std::optional<Execution> own_execution(int threads) {
  const auto host = own_host_instance(threads);
  if (!host) return std::nullopt;
  return Execution{.device = own_device_instance(*host), .host = *host};
}

}  // namespace myowave::solver
