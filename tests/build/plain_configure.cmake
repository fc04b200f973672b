# cmake -DSOURCE=.. -DWORK=.. -DKOKKOS=<prefix> -DBACKEND=.. -P plain_configure.cmake
# Configures with only the path of Kokkos given: checks the summary, and compiles a source that includes Kokkos.
function(run)
  execute_process(COMMAND ${CMAKE_COMMAND} ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(status)
    list(JOIN ARGV " " arguments)
    message(FATAL_ERROR "cmake ${arguments}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(-G Ninja -S ${SOURCE} -B ${WORK} -DKokkos_ROOT=${KOKKOS})
if(NOT output MATCHES "excitation on  ${BACKEND}\n" OR NOT output MATCHES "build          Release: libraries, apps, tests, bench\n")
  message(FATAL_ERROR "not the summary of a plain build on ${BACKEND}: ${output}")
endif()
# Only an object: linking needs the libc of Debian's Kokkos, which ./dev provides.
run(--build ${WORK} --target solver/CMakeFiles/myowave_solver.dir/run/device_memory.cpp.o)
