# cmake -DDOXYGEN=<doxygen> -DDOXYFILE=<that of the target docs> -DSOURCE=<project> -DHTML=<where it writes>
# -P documentation.cmake: doxygen gives no warning, and the headers' comments are on the right pages.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${HTML})
execute_process(COMMAND ${DOXYGEN} ${DOXYFILE} WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "doxygen: ${status}")
endif()

# The words on a page, without tags, one space between them.
function(read_page name result)
  file(GLOB page ${HTML}/${name}.html)
  file(READ "${page}" text)
  string(REGEX REPLACE "<[^>]*>" " " text "${text}")
  string(REGEX REPLACE "(&#160;|[ \n])+" " " text "${text}")
  string(REPLACE "&amp;" "&" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

function(tells name sentence)
  read_page(${name} text)
  string(FIND "${text}" "${sentence}" position)
  if(position EQUAL -1)
    message(SEND_ERROR "${name}.html does not say: ${sentence}")
  endif()
endfunction()

# Comments inside functions are not on a page.
function(does_not_tell name sentence)
  read_page(${name} text)
  string(FIND "${text}" "${sentence}" position)
  if(NOT position EQUAL -1)
    message(SEND_ERROR "${name}.html says: ${sentence}")
  endif()
endfunction()

tells(index "myowave simulates excitable muscle")
tells(md_solver_MODEL "Order of a step s, t = s dt")
tells(plan_8hpp "The plan of a run: which parts of the model run")
tells(namespacemyowave_1_1solver "Plan make_plan (const Scene &) Uses 64-bit arithmetic and allocates nothing")
tells(structmyowave_1_1solver_1_1SolveReport "double min_J = 0 smallest det F at any corner of any element")
tells(classmyowave_1_1solver_1_1Equilibrium
  "Equilibrium (const ExecutionSpace &, const elastic::ElementGrid &, const MechanicsSettings &) Starts undeformed.")
tells(element_8hpp "R_(n,i) = sum_g w_g P_iM Psi_n,M P = dw/dF")
tells(namespacemyowave_1_1elastic "+ 1) / 2 The lower triangle of K by rows")
does_not_tell(namespacemyowave_1_1elastic "Psi_n,M A_iMjN of row i, at jN")
