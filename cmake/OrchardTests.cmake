# What the tests of all modules share.

# orchard_add_tests(module SOURCES .. [LINK ..] [LONG suites..]): one executable and one ctest label per module.
# All tests are "quick"; the suites named take their random cases from tests/support/effort.h, and are once more, with
# twenty times as many and fresh ones, a test that is "long".
function(orchard_add_tests name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LONG" ${ARGN})
  set(target orchard_${name}_tests)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE orchard_flags ${ARG_LINK} GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
  # Most of a test's time is its compiler's, and GCC 12's optimiser sees bounds broken within std::string's own code.
  set(options -O1 -Wno-array-bounds)
  target_compile_options(${target} PRIVATE ${options})
  if(name MATCHES "^(runtime|broad_phase|broad_phase_methods|detector|threads)$")
    orchard_precompile_once(${target} runtime_tests OPTIONS ${options} LINK GTest::gtest
      HEADERS <gtest/gtest.h> ${ORCHARD_STANDARD_HEADERS})
  else()
    orchard_precompile_once(${target} construction_tests OPTIONS ${options} LINK Eigen3::Eigen GTest::gtest
      HEADERS <gtest/gtest.h> ${ORCHARD_CONSTRUCTION_HEADERS})
  endif()
  orchard_unite(${target})
  target_compile_definitions(${target} PRIVATE
    ORCHARD_DATA_DIR="${PROJECT_SOURCE_DIR}/data" ORCHARD_SHARED_MODELS="${PROJECT_SOURCE_DIR}/../shared/models")
  gtest_discover_tests(${target} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60 DISCOVERY_MODE PRE_TEST)
  # Two labels are more than gtest_discover_tests can pass on.
  set(labels ${CMAKE_CURRENT_BINARY_DIR}/${target}_labels.cmake)
  file(WRITE ${labels} "set_tests_properties(\${${target}_TESTS} PROPERTIES LABELS \"${name};quick\")\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels})
  foreach(suite IN LISTS ARG_LONG)
    add_test(NAME ${name}.long.${suite} COMMAND ${target} --gtest_filter=${suite})
    set_tests_properties(${name}.long.${suite} PROPERTIES LABELS "${name};long" ENVIRONMENT ORCHARD_MORE=20 TIMEOUT 7200)
  endforeach()
endfunction()
