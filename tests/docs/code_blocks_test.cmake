# cmake -DPYTHON=.. -DCOMPILER=.. -DROOTS=.. -DPAGE=.. -DPRELUDE=.. -DOUT=.. -P: code_blocks.py, and the compiler's word on it.
if(NOT PYTHON)
  message("skipped: there is no python3")
  return()
endif()
execute_process(COMMAND ${PYTHON} ${CMAKE_CURRENT_LIST_DIR}/code_blocks.py ${PAGE} ${PRELUDE} ${OUT} COMMAND_ERROR_IS_FATAL ANY)
list(TRANSFORM ROOTS PREPEND -I)
execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only -Wall -Werror -Wno-unused -Wno-shadow ${ROOTS} ${OUT}
  COMMAND_ERROR_IS_FATAL ANY)
