# cmake -DFIRST=program -DSECOND=program [-DEMULATOR=..] -P same_output.cmake: both succeed and print the same, which is
# something. EMULATOR: a list, the command that runs programs for another machine
foreach(program IN ITEMS FIRST SECOND)
  execute_process(COMMAND ${EMULATOR} ${${program}} RESULT_VARIABLE result OUTPUT_VARIABLE ${program}_output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${${program}} failed: ${result}")
  endif()
endforeach()
string(LENGTH "${FIRST_output}" length)
if(length LESS 100 OR NOT FIRST_output STREQUAL SECOND_output)
  message(FATAL_ERROR "the outputs differ:\n${FIRST_output}\n---\n${SECOND_output}")
endif()
