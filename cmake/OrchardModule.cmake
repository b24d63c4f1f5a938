# Build functions shared by every module.

# The flags that orchard's own code must compile cleanly with. -ffp-contract=off: the same bytes out on every machine.
add_library(orchard_flags INTERFACE)
target_compile_features(orchard_flags INTERFACE cxx_std_20)
target_compile_options(orchard_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -ffp-contract=off)
if(ORCHARD_WARNINGS_AS_ERRORS)
  target_compile_options(orchard_flags INTERFACE -Werror)
endif()
if(ORCHARD_SANITIZE)
  target_compile_options(orchard_flags INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(orchard_flags INTERFACE -fsanitize=address,undefined)
endif()
if(ORCHARD_SANITIZE_THREADS)
  if(ORCHARD_SANITIZE)
    message(FATAL_ERROR "ORCHARD_SANITIZE and ORCHARD_SANITIZE_THREADS exclude each other: choose one")
  endif()
  target_compile_options(orchard_flags INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(orchard_flags INTERFACE -fsanitize=thread)
endif()

# What most files of the construction include, read once for each target: a third to a half of its compile time.
set(ORCHARD_STANDARD_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <memory> <numeric>
  <optional> <span> <string> <utility> <vector>)
set(ORCHARD_CONSTRUCTION_HEADERS <Eigen/Core> <Eigen/Geometry> ${ORCHARD_STANDARD_HEADERS})

# orchard_precompile(target headers..), unless ORCHARD_PRECOMPILE is off.
function(orchard_precompile target)
  if(ORCHARD_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# orchard_add_module(name COMPONENT component SOURCES .. [PUBLIC ..] [PRIVATE ..])
# makes the library orchard::name with its own include root, so that an arrow that is not declared does not compile.
function(orchard_add_module name)
  cmake_parse_arguments(ARG "" "COMPONENT" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target orchard_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(orchard::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})  # "room/header.h"
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE $<BUILD_INTERFACE:orchard_flags> ${ARG_PRIVATE})
  if(NOT name MATCHES "^(runtime|broad_phase_methods)$")  # which are small, and need nothing to be built but a compiler
    set(headers ${ORCHARD_CONSTRUCTION_HEADERS})
    if(TBB::tbb IN_LIST ARG_PRIVATE)
      list(APPEND headers <tbb/blocked_range.h> <tbb/enumerable_thread_specific.h> <tbb/parallel_for.h>)
    endif()
    orchard_precompile(${target} ${headers})
  endif()
  install(TARGETS ${target} EXPORT orchard-${ARG_COMPONENT} COMPONENT ${ARG_COMPONENT}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${ARG_COMPONENT})
  set_property(GLOBAL APPEND PROPERTY ORCHARD_COMPONENTS ${ARG_COMPONENT})
endfunction()

# orchard_add_tests(module SOURCES .. [LINK ..] [LONG suites..]): one executable and one ctest label per module. All tests
# are "quick"; the suites named take their random cases from tests/support/effort.h, and are once more, with twenty
# times as many and fresh ones, a test that is "long".
function(orchard_add_tests name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LONG" ${ARGN})
  set(target orchard_${name}_tests)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE orchard_flags ${ARG_LINK} GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
  # Most of a test's time is its compiler's, and GCC 12's optimiser sees bounds broken within std::string's own code.
  target_compile_options(${target} PRIVATE -O1 -Wno-array-bounds)
  if(name STREQUAL runtime OR name STREQUAL broad_phase)
    orchard_precompile(${target} <gtest/gtest.h> ${ORCHARD_STANDARD_HEADERS})
  else()
    orchard_precompile(${target} <gtest/gtest.h> ${ORCHARD_CONSTRUCTION_HEADERS})
  endif()
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

# One export set per component, so that find_package(orchard COMPONENTS runtime) needs nothing else.
function(orchard_install_package)
  include(CMakePackageConfigHelpers)
  set(directory ${CMAKE_INSTALL_LIBDIR}/cmake/orchard)
  get_property(components GLOBAL PROPERTY ORCHARD_COMPONENTS)
  list(REMOVE_DUPLICATES components)
  foreach(component IN LISTS components)
    install(EXPORT orchard-${component} NAMESPACE orchard:: DESTINATION ${directory} COMPONENT ${component})
  endforeach()
  # Beside those of the run-time and its methods, which install runtime/LICENSE themselves.
  if(ORCHARD_CONSTRUCTION)
    list(APPEND components apps)
    list(REMOVE_ITEM components runtime broad_phase_methods)
    foreach(component IN LISTS components)
      install(FILES ${PROJECT_SOURCE_DIR}/LICENSES/GPL-3.0-or-later.txt
        DESTINATION ${CMAKE_INSTALL_DOCDIR}/${component} COMPONENT ${component})
    endforeach()
  endif()
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/orchardConfig.cmake.in
    ${PROJECT_BINARY_DIR}/orchardConfig.cmake INSTALL_DESTINATION ${directory})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/orchardConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/orchardConfig.cmake ${PROJECT_BINARY_DIR}/orchardConfigVersion.cmake
    DESTINATION ${directory} COMPONENT runtime)
endfunction()
