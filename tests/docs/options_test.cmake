# cmake -DPROGRAM=.. -DPAGE=.. -DOUT=.. -P: whether the page of all options is what the program says.
execute_process(COMMAND ${PROGRAM} reference markdown OUTPUT_FILE ${OUT} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${PAGE} ${OUT} RESULT_VARIABLE different)
if(different)
  message(FATAL_ERROR "${PAGE} is not what the program says; write it again: orchard reference markdown > docs/reference/command-line.md")
endif()
