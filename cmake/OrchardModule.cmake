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

# What most files of the construction include, read once for all modules and once for all tests: a third to a half of the
# compile time of a file.
set(ORCHARD_STANDARD_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <memory> <numeric>
  <optional> <span> <string> <utility> <vector>)
set(ORCHARD_CONSTRUCTION_HEADERS <Eigen/Core> <Eigen/Geometry> ${ORCHARD_STANDARD_HEADERS})
set(ORCHARD_TBB_HEADERS <tbb/blocked_range.h> <tbb/enumerable_thread_specific.h> <tbb/parallel_for.h>)

# orchard_precompile(target headers..), unless ORCHARD_PRECOMPILE is off.
function(orchard_precompile target)
  if(ORCHARD_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# orchard_precompile_once(target name [PIC] [OPTIONS ..] [LINK ..] HEADERS ..): the same, but the headers are compiled for
# the first target that asks for this name; the others, whose flags are the same, take what there is.
function(orchard_precompile_once target name)
  cmake_parse_arguments(ARG "PIC" "" "OPTIONS;LINK;HEADERS" ${ARGN})
  if(NOT ORCHARD_PRECOMPILE)
    return()
  elseif(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # which alone lets other flags of CGAL's or a test's pass
    target_precompile_headers(${target} PRIVATE ${ARG_HEADERS})
    return()
  endif()
  set(owner orchard_${name}_headers)
  if(NOT TARGET ${owner})
    set(empty ${PROJECT_BINARY_DIR}/${owner}.cpp)
    file(CONFIGURE OUTPUT ${empty} CONTENT "")
    add_library(${owner} OBJECT ${empty})
    set_target_properties(${owner} PROPERTIES POSITION_INDEPENDENT_CODE ${ARG_PIC})
    target_compile_options(${owner} PRIVATE ${ARG_OPTIONS})
    target_link_libraries(${owner} PRIVATE orchard_flags ${ARG_LINK})
    target_precompile_headers(${owner} PRIVATE ${ARG_HEADERS})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# orchard_unite(target [APART ..]): with ORCHARD_UNITY, files are compiled eight at a time, in the order in which they are
# listed, and all NAME_cgal.cpp at once: what they instantiate of CGAL takes longer than all else. APART: by themselves, for
# they have names of their own in unnamed namespaces that others have as well. A build without ORCHARD_UNITY compiles less
# after a change.
function(orchard_unite target)
  cmake_parse_arguments(ARG "" "" "APART" ${ARGN})
  if(NOT ORCHARD_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(count 0)
  foreach(source IN LISTS sources)
    if(source IN_LIST ARG_APART)
      continue()
    elseif(source MATCHES "_cgal\\.cpp$")
      set(group cgal)
    else()
      math(EXPR group "${count} / 8")
      math(EXPR count "${count} + 1")
    endif()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${target}_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# orchard_add_module(name COMPONENT component SOURCES .. [APART ..] [PUBLIC ..] [PRIVATE ..])
# makes the library orchard::name with its own include root, so that an arrow that is not declared does not compile.
function(orchard_add_module name)
  cmake_parse_arguments(ARG "" "COMPONENT" "SOURCES;APART;PUBLIC;PRIVATE" ${ARGN})
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
  if(name MATCHES "^(runtime|broad_phase_methods)$")  # file by file, so that a game links no more than it uses
    orchard_precompile_once(${target} runtime PIC HEADERS ${ORCHARD_STANDARD_HEADERS})
  else()
    orchard_precompile_once(${target} construction PIC LINK Eigen3::Eigen TBB::tbb
      HEADERS ${ORCHARD_CONSTRUCTION_HEADERS} ${ORCHARD_TBB_HEADERS})
    orchard_unite(${target} APART ${ARG_APART})
  endif()
  install(TARGETS ${target} EXPORT orchard-${ARG_COMPONENT} COMPONENT ${ARG_COMPONENT}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${ARG_COMPONENT})
  set_property(GLOBAL APPEND PROPERTY ORCHARD_COMPONENTS ${ARG_COMPONENT})
endfunction()

# orchard_add_tests(module SOURCES .. [APART ..] [LINK ..] [LONG suites..]): one executable and one ctest label per module. All tests
# are "quick"; the suites named take their random cases from tests/support/effort.h, and are once more, with twenty
# times as many and fresh ones, a test that is "long".
function(orchard_add_tests name)
  cmake_parse_arguments(ARG "" "" "SOURCES;APART;LINK;LONG" ${ARGN})
  set(target orchard_${name}_tests)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE orchard_flags ${ARG_LINK} GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
  # Most of a test's time is its compiler's, and GCC 12's optimiser sees bounds broken within std::string's own code.
  set(options -O1 -Wno-array-bounds)
  target_compile_options(${target} PRIVATE ${options})
  if(name STREQUAL runtime OR name STREQUAL broad_phase)
    orchard_precompile_once(${target} runtime_tests OPTIONS ${options} LINK GTest::gtest
      HEADERS <gtest/gtest.h> ${ORCHARD_STANDARD_HEADERS})
  else()
    orchard_precompile_once(${target} construction_tests OPTIONS ${options} LINK Eigen3::Eigen GTest::gtest
      HEADERS <gtest/gtest.h> ${ORCHARD_CONSTRUCTION_HEADERS})
  endif()
  orchard_unite(${target} APART ${ARG_APART})
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
