# cmake -DCHECK=<CheckLayers.cmake> -DWORK=<scratch folder> -P check_layers_cases.cmake: each rule of
# the layers rejects what it forbids and accepts similar code.
cmake_minimum_required(VERSION 3.25)

function(check path line output_result status_result)
  file(REMOVE_RECURSE ${WORK})
  file(WRITE ${WORK}/kernels/base/views.hpp "#pragma once\n#include <Kokkos_Core.hpp>\n")
  file(WRITE ${WORK}/solver/mechanics/linear/direct_solver.cpp "#include <cholmod.h>\ncholmod_common common;\n")
  file(APPEND ${WORK}/${path} "// heading\n\n${line}\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -DSOURCE=${WORK} -P ${CHECK} RESULT_VARIABLE status
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  # A long message is wrapped.
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  set(${output_result} "${output}" PARENT_SCOPE)
  set(${status_result} ${status} PARENT_SCOPE)
endfunction()

function(rejects path line complaint)
  check(${path} "${line}" output status)
  string(FIND "${output}" "${complaint}" position)
  if(status EQUAL 0 OR position EQUAL -1)
    message(SEND_ERROR "${path} with `${line}`: expected `${complaint}`, got ${status} `${output}`")
  endif()
endfunction()

function(accepts path line)
  check(${path} "${line}" output status)
  if(NOT status EQUAL 0)
    message(SEND_ERROR "${path} with `${line}`: expected no complaint, got `${output}`")
  endif()
endfunction()

# One include that runs upwards or sideways, of each room.
function(rejects_include room target)
  rejects(${room}/a.cpp "#include \"${target}/b.hpp\"" "${room}/a.cpp:3: ${room} must not include ${target}")
endfunction()
foreach(pair
    kernels/base:kernels/cell kernels/cell:kernels/tissue kernels/tissue:kernels/elastic kernels/elastic:kernels/transfer
    kernels/transfer:solver/base kernels/observe:kernels/transfer
    solver/base:solver/scene solver/scene:solver/excitation solver/excitation:solver/mechanics
    solver/excitation:kernels/elastic solver/mechanics/linear:solver/mechanics solver/mechanics:solver/excitation
    solver/mechanics:kernels/tissue solver/coupling:solver/analysis solver/analysis:solver/run solver/run:solver/studies
    solver/studies:apps/base
    apps/base:apps/input apps/input:apps/draw apps/draw:apps/input apps/results:apps/sweep apps/sweep:apps/report
    apps/report:apps/paper apps/tradeoff:apps/stability apps/stability:apps/tradeoff apps/paper:apps/cli)
  string(REPLACE ":" ";" pair ${pair})
  rejects_include(${pair})
endforeach()
rejects(kernels/elastic/a.hpp "#include <kernels/transfer/b.hpp>" "kernels/elastic must not include kernels/transfer")
rejects(apps/cli/a.cpp "#include \"tests/support/b.hpp\"" "apps/cli must not include tests/support/b.hpp")
rejects(kernels/base/a.hpp "#include \"views.hpp\"" "include \"views.hpp\" by its path from the root")
rejects(kernels/other/a.hpp "int f();" "no such room: kernels/other")
rejects(solver/a.cpp "int f();" "no such room: solver")
accepts(kernels/transfer/a.hpp "#include \"kernels/elastic/b.hpp\"\n#include \"kernels/tissue/b.hpp\"")
accepts(solver/run/a.cpp "#include \"kernels/observe/b.hpp\"\n#include <vector>\nthrow 1;")
accepts(apps/cli/a.cpp "#include \"solver/base/b.hpp\"\n#include \"generated.hpp\"")

rejects(kernels/cell/a.hpp "#include <iostream>" "kernels/ must not include <iostream>")
rejects(kernels/cell/a.hpp "#include <vector>" "kernels/ must not include <vector>")
rejects(kernels/cell/a.hpp "#include <fmt/format.h>" "kernels/ must not include fmt/format.h")
rejects(kernels/cell/a.hpp "  if (x) throw 1;" "no exceptions in kernels/")
rejects(kernels/cell/a.hpp "double cache = 0;" "no mutable global")
rejects(kernels/cell/a.hpp "inline int table[4] = {1, 2};" "no mutable global")
rejects(kernels/cell/a.hpp "Kokkos::View<double*> scratch;" "no mutable global")
rejects(kernels/cell/a.hpp "  static int calls = 0;" "no mutable global")
accepts(kernels/cell/a.hpp "#include <cmath>\n#include <Kokkos_MathematicalFunctions.hpp>")
accepts(kernels/cell/a.hpp "inline constexpr double a = 0.1;\nconst int n = 3;\n  static constexpr int m = 2;")
accepts(kernels/cell/a.hpp "template <class Real>\nstruct Params;\nusing T = double;\nint f(int a = 0);\nnamespace x = y;")
accepts(kernels/cell/a.hpp "struct Params {\n  double a = 0.1;\n  static double rate(double V);\n};")
accepts(kernels/cell/a.hpp "// throw nothing, no std::vector")

rejects(apps/cli/a.cpp "  Kokkos::parallel_for(n, f);" "no parallel loop in apps/")
accepts(apps/cli/a.cpp "  Kokkos::ScopeGuard guard;")
rejects(solver/base/a.cpp "#include <Eigen/Dense>" "solver/base must not include Eigen/Dense: Eigen is for tests")
accepts(bench/a.cpp "#include <Eigen/SparseCholesky>")
rejects(apps/cli/a.cpp "#include <suitesparse/cholmod.h>" "apps/cli/a.cpp, solver/mechanics/linear/direct_solver.cpp")
rejects(solver/base/a.cpp "  cholmod_start(c);" "solver/base/a.cpp, solver/mechanics/linear/direct_solver.cpp")
accepts(solver/base/a.cpp "#include <iostream>  // not cholmod.h")
