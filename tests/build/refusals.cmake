# cmake -DSOURCE=.. -DWORK=.. -DKOKKOS=<prefix> -P wrong_kokkos_cases.cmake
# What a user is told whose Kokkos is not the one that the preset is for.
set(failed "")
function(expect what words)
  file(REMOVE_RECURSE ${WORK})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE}/cmake/find_kokkos -B ${WORK} ${ARGN}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  # CMake breaks lines where it likes.
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(status EQUAL 0 OR NOT output MATCHES "${words}")
    set(failed "${failed}${what}: ${output}\n" PARENT_SCOPE)
  endif()
endfunction()

expect("no such backend" "has the backends .* and not HIP, which this preset is for\\. To mend it: .*-DKokkos_ENABLE_HIP=ON -DKokkos_ARCH_AMD_GFX942=ON.*--list-presets"
       -DKokkos_ROOT=${KOKKOS} -DMYOWAVE_BACKEND=HIP "-DMYOWAVE_GPU=AMD_GFX942;AMD_GFX942_APU")
expect("built for another GPU" "and not for HOPPER90, which this preset is for.*-DMYOWAVE_GPU=NAME"
       -DKokkos_ROOT=${KOKKOS} -DMYOWAVE_GPU=HOPPER90)
file(WRITE ${WORK}_old/lib/cmake/Kokkos/KokkosConfig.cmake "")
file(WRITE ${WORK}_old/lib/cmake/Kokkos/KokkosConfigVersion.cmake "set(PACKAGE_VERSION 3.4.01)\nset(PACKAGE_VERSION_COMPATIBLE FALSE)")
expect("an old one" "needs Kokkos >= 4\\.6\\. Looked at and not taken \\(version [^)]*3\\.4\\.01.*KokkosConfig\\.cmake.*-DKokkos_ROOT=PREFIX"
       -DKokkos_ROOT=${WORK}_old -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF)
if(failed)
  message(FATAL_ERROR "${failed}")
endif()
