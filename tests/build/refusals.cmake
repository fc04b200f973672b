# cmake -DSOURCE=.. -DWORK=.. -DKOKKOS=<prefix> -P refusals.cmake
# Messages for a Kokkos that does not match the preset, and for libraries that are too old.
set(failed "")
function(expect what words)
  file(REMOVE_RECURSE ${WORK})
  execute_process(COMMAND ${CMAKE_COMMAND} ${ARGN} -B ${WORK}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  # CMake breaks lines where it likes.
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(status EQUAL 0 OR NOT output MATCHES "${words}")
    set(failed "${failed}${what}: ${output}\n" PARENT_SCOPE)
  endif()
endfunction()

# A package that is found, has that version and sets the further arguments.
function(write_package folder name version compatible)
  file(WRITE ${folder}/lib/cmake/${name}/${name}Config.cmake ${ARGN})
  file(WRITE ${folder}/lib/cmake/${name}/${name}ConfigVersion.cmake
       "set(PACKAGE_VERSION ${version})\nset(PACKAGE_VERSION_COMPATIBLE ${compatible})")
endfunction()

set(find_kokkos -S ${SOURCE}/cmake/find_kokkos)
expect("no such backend" "has the backends .* and not HIP, which this preset is for\\. To fix it: .*-DKokkos_ENABLE_HIP=ON -DKokkos_ARCH_AMD_GFX942=ON.*--list-presets"
       ${find_kokkos} -DKokkos_ROOT=${KOKKOS} -DMYOWAVE_BACKEND=HIP "-DMYOWAVE_GPU=AMD_GFX942;AMD_GFX942_APU")
write_package(${WORK}_old Kokkos 3.4.01 FALSE "")
expect("an old one" "needs Kokkos >= 4\\.6\\. Found but not accepted \\(version [^)]*3\\.4\\.01.*KokkosConfig\\.cmake.*-DKokkos_ROOT=PREFIX"
       ${find_kokkos} -DKokkos_ROOT=${WORK}_old -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF)

set(ampere "set(Kokkos_DEVICES CUDA SERIAL)\nset(Kokkos_ARCH AMPERE80)\n")
write_package(${WORK}_ampere Kokkos 4.6.1 TRUE "${ampere}set(Kokkos_OPTIONS CUDA_LAMBDA)")
expect("built for another GPU" "for AMPERE80 and not for HOPPER90, which this preset is for.*-DMYOWAVE_GPU=NAME"
       ${find_kokkos} -DKokkos_ROOT=${WORK}_ampere -DMYOWAVE_GPU=HOPPER90)
write_package(${WORK}_no_lambda Kokkos 4.6.1 TRUE "${ampere}set(Kokkos_OPTIONS CUDA_CONSTEXPR)")
expect("no lambdas in device code" "without CUDA_LAMBDA.*build it again with -DKokkos_ENABLE_CUDA_LAMBDA=ON"
       ${find_kokkos} -DKokkos_ROOT=${WORK}_no_lambda)

# The presets themselves.
write_package(${WORK}_host Kokkos 4.6.1 TRUE "set(Kokkos_DEVICES OPENMP)")
set(host -S ${SOURCE} -DKokkos_ROOT=${WORK}_host)
expect("preset hip-mi300" "not HIP, which this preset is for.*-DKokkos_ENABLE_HIP=ON -DKokkos_ARCH_AMD_GFX942=ON"
       ${host} --preset hip-mi300)
expect("preset cuda-ampere" "not CUDA, which this preset is for.*-DKokkos_ENABLE_CUDA=ON -DKokkos_ARCH_AMPERE80=ON"
       ${host} --preset cuda-ampere)

# Found, but too old; all such libraries at once.
write_package(${WORK}_libraries nlohmann_json 3.9.1 TRUE "")
write_package(${WORK}_libraries CLI11 1.9 TRUE "")
expect("old libraries" "too old: CLI11 1\\.9, at least 2\\.1 is needed; nlohmann_json 3\\.9\\.1, at least 3\\.11 is needed\\. .*CMAKE_PREFIX_PATH"
       ${host} -DCLI11_ROOT=${WORK}_libraries -Dnlohmann_json_ROOT=${WORK}_libraries)
if(failed)
  message(FATAL_ERROR "${failed}")
endif()
