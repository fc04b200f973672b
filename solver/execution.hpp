// Where a run computes. Kernels of two threads of the program may go on at once where their instances differ.
#pragma once

#include <Kokkos_Core.hpp>
#include <optional>
#include <type_traits>

namespace myowave::solver {

struct Execution {
  Kokkos::DefaultExecutionSpace device{};    // the excitation
  Kokkos::DefaultHostExecutionSpace host{};  // the mechanics
};

// A host instance beside the default one. Empty where the backend has a single one, or a single core for
// everything.
inline std::optional<Kokkos::DefaultHostExecutionSpace> own_host_instance([[maybe_unused]] int threads) {
  using Host = Kokkos::DefaultHostExecutionSpace;
#ifdef KOKKOS_ENABLE_OPENMP
  if constexpr (std::is_same_v<Host, Kokkos::OpenMP>) return Kokkos::OpenMP(threads);
#endif
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<Host, Kokkos::Serial>) return Kokkos::Serial(Kokkos::NewInstance{});
#endif
  return std::nullopt;
}

// Instances of one thread of the program: host threads as given, and on a device a queue (stream) of its own,
// so that the kernels of several small sheets fill it together. Empty as above.
inline std::optional<Execution> own_execution(int threads) {
  const auto host = own_host_instance(threads);
  if (!host) return std::nullopt;
  if constexpr (std::is_same_v<Kokkos::DefaultExecutionSpace, Kokkos::DefaultHostExecutionSpace>)
    return Execution{*host, *host};
  else
    return Execution{Kokkos::Experimental::partition_space(Kokkos::DefaultExecutionSpace(), 1)[0], *host};
}

}  // namespace myowave::solver
