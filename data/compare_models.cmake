# Runs GENERATOR into OUTPUT_DIR and compares every model with the one in REFERENCE_DIR.
file(MAKE_DIRECTORY "${OUTPUT_DIR}")
execute_process(COMMAND "${GENERATOR}" "${OUTPUT_DIR}" RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${GENERATOR} failed: ${result}")
endif()

set(changed)
foreach(name IN ITEMS lamp faucet ship)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -E compare_files
            "${OUTPUT_DIR}/${name}.obj" "${REFERENCE_DIR}/${name}.obj"
    RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(APPEND changed "${name}.obj")
  endif()
endforeach()
if(changed)
  message(FATAL_ERROR "differs from ${REFERENCE_DIR}: ${changed}")
endif()
