# The installed construction, used by a project that knows nothing else.
# cmake -D<what stands below>=.. -P install_test.cmake
#   BUILD: the build tree; SCRATCH: a directory to work in; SOURCE: orchard's root
#   GENERATOR, COMPILER, FLAGS: those of the build
set(prefix "${SCRATCH}/prefix")

function(must_run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nfailed (${result}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${SCRATCH}")
foreach(component IN ITEMS runtime construction)
  must_run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}" --component ${component})
endforeach()
# Each component brings the licence that it is under.
function(must_be_installed file source)
  file(GLOB found "${prefix}/*/doc/orchard/${file}")
  if(NOT found)
    message(FATAL_ERROR "the installation has no doc/orchard/${file}")
  endif()
  must_run("${CMAKE_COMMAND}" -E compare_files "${found}" "${SOURCE}/${source}")
endfunction()
must_be_installed(runtime/LICENSE runtime/LICENSE)
must_be_installed(construction/GPL-3.0-or-later.txt LICENSES/GPL-3.0-or-later.txt)
must_run("${CMAKE_COMMAND}" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_FLAGS=${FLAGS}"
  "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_BUILD_TYPE=Release -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
  -S "${SOURCE}/examples/construction" -B "${SCRATCH}/example")
must_run("${CMAKE_COMMAND}" --build "${SCRATCH}/example")
must_run("${SCRATCH}/example/build_tree" "${SOURCE}/data/ship.obj")
if(NOT output MATCHES "medial vertices, [0-9]+ spheres, certified: yes.*three radii apart: no contact")
  message(FATAL_ERROR "the example built no certified tree:\n${output}")
endif()
execute_process(COMMAND "${SCRATCH}/example/build_tree" "${SOURCE}/CMakeLists.txt" RESULT_VARIABLE result
  ERROR_VARIABLE output)
if(NOT result EQUAL 2)
  message(FATAL_ERROR "the example took a text for a mesh (${result}):\n${output}")
endif()
