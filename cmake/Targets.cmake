# Settings of every target of the project, and of nothing that is linked to it: a program that uses
# the libraries chooses its own warnings and code generation.
include(CheckCXXCompilerFlag)

set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

add_library(myowave_options INTERFACE)
target_compile_features(myowave_options INTERFACE cxx_std_20)
# fmt 9 drops constexpr for nvcc, although its consteval format strings then do not compile.
target_compile_definitions(myowave_options INTERFACE FMT_USE_CONSTEXPR=1)
# Flags that GCC and Clang share. A device's compiler gets them too: nvcc_wrapper is GNU to CMake and hands them to the
# host's compiler, hipcc is Clang.
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(myowave_options INTERFACE -Wall -Wextra -Wshadow)
  # No kernel reads errno, and without it sqrt and friends vectorise. The loops along a row are marked
  # `omp simd`, which a Kokkos without OpenMP does not switch on.
  target_compile_options(myowave_options INTERFACE -fno-math-errno -fopenmp-simd)
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # It warns of each `omp simd` that it does not turn into vector instructions, which is no mistake.
    target_compile_options(myowave_options INTERFACE -Wno-pass-failed)
  endif()
  if(MYOWAVE_NATIVE)
    check_cxx_compiler_flag(-march=native MYOWAVE_HAS_MARCH_NATIVE)
    if(MYOWAVE_HAS_MARCH_NATIVE)
      # All instructions of this processor, but no tuning for a model: GCC takes one that it does not know
      # for its nearest relative, which costs a step a quarter on an EPYC of family 26 with GCC 12.
      target_compile_options(myowave_options INTERFACE -march=native -mtune=generic)
    endif()
  endif()
endif()
if(MYOWAVE_SANITIZE)
  target_compile_options(myowave_options INTERFACE -fsanitize=${MYOWAVE_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  target_link_options(myowave_options INTERFACE -fsanitize=${MYOWAVE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # The sanitizers' checks make GCC see uninitialised values where there are none (GCC manual,
    # -fsanitize); the other presets keep the warning.
    target_compile_options(myowave_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# The git revision that a build was made from, looked up at every build.
add_custom_target(myowave_revision
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
          -DOUTPUT=${PROJECT_BINARY_DIR}/generated/myowave_version.hpp
          -P ${PROJECT_SOURCE_DIR}/cmake/Revision.cmake
  BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/myowave_version.hpp
  COMMENT "Looking up the git revision")
add_library(myowave_version INTERFACE)
add_dependencies(myowave_version myowave_revision)
target_include_directories(myowave_version INTERFACE ${PROJECT_BINARY_DIR}/generated)
