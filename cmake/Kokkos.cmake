find_package(Kokkos 4.6 QUIET)
if(NOT Kokkos_FOUND)
  message(FATAL_ERROR
    "myowave needs Kokkos >= 4.6. Point CMake to it with -DKokkos_ROOT=PREFIX (Spack: `spack load kokkos`), "
    "or run ./dev setup, which unpacks Debian's OpenMP build into .deps/ and leaves the system alone.")
endif()
