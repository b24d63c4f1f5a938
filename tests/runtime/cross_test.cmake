# The run-time and its quick tests for another machine: cmake -DPRESET=.. -DSOURCE=.. -DCOMPILER=.. -DEMULATOR=.. -P cross_test.cmake
#   COMPILER, EMULATOR: programs that the preset needs; where one is not installed the test says so and is skipped
foreach(program IN ITEMS "${COMPILER}" "${EMULATOR}")
  unset(found CACHE)
  find_program(found NAMES "${program}" PATHS /usr/lib/wine)
  if(NOT found)
    message("skipped: ${program} is not installed")
    return()
  endif()
endforeach()

function(must_run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${SOURCE}" RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nfailed (${result}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

must_run("${CMAKE_COMMAND}" --preset ${PRESET})
must_run("${CMAKE_COMMAND}" --build --preset ${PRESET})
must_run("${CMAKE_CTEST_COMMAND}" --preset ${PRESET} -L quick -LE install)
string(REGEX MATCH "[0-9]+% tests passed[^\n]*" passed "${output}")
message("${PRESET}: ${passed}")
