# Finds Kokkos, and stops if it does not match the preset.
#
# MYOWAVE_BACKEND  backend the excitation must run on: OPENMP, SERIAL, THREADS, CUDA, HIP; empty: the default of the Kokkos found
# MYOWAVE_GPU      architecture that Kokkos must be built for, by Kokkos' name (HOPPER90), or a list of accepted ones; empty: any
set(MYOWAVE_BACKEND "" CACHE STRING "Kokkos backend that the excitation must run on; empty: the default of the Kokkos found")
set(MYOWAVE_GPU "" CACHE STRING "GPU architecture that Kokkos must be built for, one of this list; empty: any")
set_property(CACHE MYOWAVE_BACKEND PROPERTY STRINGS "" OPENMP SERIAL THREADS CUDA HIP)

find_package(Kokkos 4.6 QUIET)
if(NOT Kokkos_FOUND)
  set(found "")
  if(Kokkos_CONSIDERED_CONFIGS)
    list(JOIN Kokkos_CONSIDERED_VERSIONS ", " versions)
    list(JOIN Kokkos_CONSIDERED_CONFIGS "\n  " configs)
    set(found "Found but not accepted (version ${versions}):\n  ${configs}\n")
  endif()
  message(FATAL_ERROR
    "myowave needs Kokkos >= 4.6. ${found}Point CMake to it with -DKokkos_ROOT=PREFIX (Spack: `spack load kokkos`), "
    "or run ./dev setup, which unpacks Debian's OpenMP build into .deps/ and does not change the system.")
endif()

# The default execution space of Kokkos: a device, else the host's threads, else one core.
foreach(backend CUDA HIP SYCL OPENMP THREADS HPX SERIAL)
  if(backend IN_LIST Kokkos_DEVICES)
    set(myowave_backend ${backend})
    break()
  endif()
endforeach()

function(require_kokkos_of_preset)
  set(options "-DKokkos_ENABLE_${MYOWAVE_BACKEND}=ON")
  set(has_gpu ON)
  if(MYOWAVE_GPU)
    list(GET MYOWAVE_GPU 0 gpu)
    string(APPEND options " -DKokkos_ARCH_${gpu}=ON")
    set(has_gpu OFF)
    foreach(architecture IN LISTS MYOWAVE_GPU)
      if(architecture IN_LIST Kokkos_ARCH)
        set(has_gpu ON)
      endif()
    endforeach()
  endif()
  list(JOIN Kokkos_DEVICES ", " devices)
  set(this "The Kokkos found, ${Kokkos_VERSION} in ${Kokkos_DIR}, has the backends ${devices}")
  set(fix "point to another one with -DKokkos_ROOT=PREFIX, build one with ${options}")
  if(MYOWAVE_BACKEND AND NOT MYOWAVE_BACKEND IN_LIST Kokkos_DEVICES)
    message(FATAL_ERROR "${this} and not ${MYOWAVE_BACKEND}, which this preset is for. To fix it: ${fix}, "
                        "or use the preset of a backend that it has (cmake --list-presets).")
  endif()
  if(MYOWAVE_BACKEND AND NOT MYOWAVE_BACKEND STREQUAL myowave_backend)
    message(FATAL_ERROR "${this} and runs on ${myowave_backend} by default, not on ${MYOWAVE_BACKEND}, which this preset is "
                        "for. To fix it: ${fix} and without ${myowave_backend}, or use the preset of ${myowave_backend}.")
  endif()
  if(NOT has_gpu)
    list(JOIN Kokkos_ARCH ", " architectures)
    message(FATAL_ERROR "${this} for ${architectures} and not for ${gpu}, which this preset is for. "
                        "To fix it: ${fix}, or give your GPU's name with -DMYOWAVE_GPU=NAME (empty: any).")
  endif()
  # Since Kokkos 5 it is always on.
  if(myowave_backend STREQUAL "CUDA" AND Kokkos_VERSION VERSION_LESS 5 AND NOT "CUDA_LAMBDA" IN_LIST Kokkos_OPTIONS)
    message(FATAL_ERROR "${this} without CUDA_LAMBDA, and kernels are lambdas. To fix it: point to another one with "
                        "-DKokkos_ROOT=PREFIX, or build it again with -DKokkos_ENABLE_CUDA_LAMBDA=ON.")
  endif()
endfunction()
require_kokkos_of_preset()

if(myowave_backend STREQUAL "CUDA" AND Kokkos_CXX_COMPILER_ID STREQUAL "NVIDIA")
  # Kernels call constexpr functions of the standard library. nvcc allows that with a flag, which Kokkos passes on
  # only if it was built with Kokkos_ENABLE_CUDA_CONSTEXPR.
  if(NOT "CUDA_CONSTEXPR" IN_LIST Kokkos_OPTIONS)
    set(MYOWAVE_NEEDS_RELAXED_CONSTEXPR ON)
  endif()
  # Sources without Kokkos go to nvcc_wrapper's host compiler.
  if(CMAKE_CXX_COMPILER MATCHES "nvcc_wrapper")
    set(MYOWAVE_HOST_ONLY --host-only)
  endif()
endif()
