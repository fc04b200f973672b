// Where a run computes. Kernels of two threads of the program can overlap if their instances differ.
#pragma once

#include <Kokkos_Core.hpp>
#include <optional>
#include <type_traits>

#include "kernels/base/row_loop.hpp"

// Everything is instantiated for Kokkos::DefaultExecutionSpace, for Kokkos::DefaultHostExecutionSpace if that
// is another, and for Kokkos::Serial if the build has it and it is neither.
#if defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL)
#define MYOWAVE_HAS_DEVICE
#endif
#if defined(KOKKOS_ENABLE_SERIAL) && (defined(KOKKOS_ENABLE_OPENMP) || defined(KOKKOS_ENABLE_THREADS))
#define MYOWAVE_HAS_SERIAL_TOO
#endif

namespace myowave::solver {

// The mechanics runs on the host: on its default space if the excitation is on a device, else where the
// excitation runs.
template <class ExecutionSpace>
using HostOf =
    std::conditional_t<runs_on_host<ExecutionSpace>, ExecutionSpace, Kokkos::DefaultHostExecutionSpace>;

template <class ExecutionSpace>
struct ExecutionOn {
  ExecutionSpace device{};        // the excitation
  HostOf<ExecutionSpace> host{};  // the mechanics
};
using Execution = ExecutionOn<Kokkos::DefaultExecutionSpace>;

// These are templates, because only in templates does `if constexpr` discard the branch of another backend.

// A host instance besides the default one. Empty if the backend has only one, or only one core.
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

// The host instance itself if the excitation runs on the host, else a queue (stream) of its own, so that the
// kernels of several small sheets can fill the device together.
template <class Device = Kokkos::DefaultExecutionSpace>
Device own_device_instance(const Kokkos::DefaultHostExecutionSpace& host) {
  if constexpr (std::is_same_v<Device, Kokkos::DefaultHostExecutionSpace>)
    return host;
  else
    return Kokkos::Experimental::partition_space(Device(), 1)[0];
}

// Instances for one thread of the program, with this many host threads. Empty as above.
inline std::optional<Execution> own_execution(int threads) {
  const auto host = own_host_instance(threads);
  if (!host) return std::nullopt;
  return Execution{.device = own_device_instance(*host), .host = *host};
}

}  // namespace myowave::solver
