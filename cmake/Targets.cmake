# Settings of the project's own targets. Programs that link the libraries choose their own warnings and code
# generation.
include(CheckCXXCompilerFlag)

set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# nvcc cannot precompile headers.
if(myowave_backend STREQUAL "CUDA")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

add_library(myowave_options INTERFACE)
target_compile_features(myowave_options INTERFACE cxx_std_20)
# fmt 9 drops constexpr for nvcc, although its consteval format strings then do not compile.
target_compile_definitions(myowave_options INTERFACE FMT_USE_CONSTEXPR=1)
# Flags that GCC and Clang share. Device compilers get them too: CMake takes nvcc_wrapper for GNU, and it passes them to
# the host compiler; hipcc is Clang.
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(myowave_options INTERFACE -Wall -Wextra -Wshadow)
  # No kernel reads errno; without it sqrt and similar functions vectorise. The loops along a row are `omp simd`,
  # which a Kokkos without OpenMP does not enable.
  target_compile_options(myowave_options INTERFACE -fno-math-errno -fopenmp-simd)
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # Clang warns of each `omp simd` loop that it does not vectorise.
    target_compile_options(myowave_options INTERFACE -Wno-pass-failed)
  endif()
  if(MYOWAVE_NATIVE)
    check_cxx_compiler_flag(-march=native MYOWAVE_HAS_MARCH_NATIVE)
    if(MYOWAVE_HAS_MARCH_NATIVE)
      # All instructions of this processor, but no tuning for a model: GCC tunes for an older relative of a model that
      # it does not know, which makes steps slower (bench/HISTORY.md).
      target_compile_options(myowave_options INTERFACE -march=native -mtune=generic)
    endif()
  endif()
endif()
if(MYOWAVE_SANITIZE)
  target_compile_options(myowave_options INTERFACE -fsanitize=${MYOWAVE_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  target_link_options(myowave_options INTERFACE -fsanitize=${MYOWAVE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # With sanitizers GCC warns of uninitialised values where there are none (GCC manual, -fsanitize). The other
    # presets keep the warning.
    target_compile_options(myowave_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# Version and git revision, read at every build. Only this library is compiled again after a commit.
add_custom_target(myowave_revision
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
          -DOUTPUT=${PROJECT_BINARY_DIR}/generated/myowave_version.hpp
          -P ${PROJECT_SOURCE_DIR}/cmake/Revision.cmake
  BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/myowave_version.hpp
  COMMENT "Reading the git revision")
add_library(myowave_version STATIC EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/apps/base/revision.cpp)
add_dependencies(myowave_version myowave_revision)
target_include_directories(myowave_version PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
target_link_libraries(myowave_version PRIVATE myowave_options)
