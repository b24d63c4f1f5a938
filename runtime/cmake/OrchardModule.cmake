# Build functions shared by every module. They lie here because the run-time is built without the rest of orchard as well.
include(GNUInstallDirs)

# The flags that orchard's own code must compile cleanly with. The same bytes out on every machine: nothing is fused into
# one rounding (-ffp-contract=off; MSVC does not unless it is told to), nothing is kept in wider registers (x87). No code
# reads errno after a square root: without it (-fno-math-errno) loops with roots are compiled to vectors, to the same bits.
add_library(orchard_flags INTERFACE)
target_compile_features(orchard_flags INTERFACE cxx_std_20)
if(CMAKE_CXX_COMPILER_FRONTEND_VARIANT STREQUAL "MSVC" OR MSVC)
  target_compile_options(orchard_flags INTERFACE /W4 /permissive- /utf-8 /fp:precise)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(orchard_flags INTERFACE /clang:-ffp-contract=off)
  endif()
  target_compile_definitions(orchard_flags INTERFACE NOMINMAX _CRT_SECURE_NO_WARNINGS)
  set(orchard_werror /WX)
else()
  target_compile_options(orchard_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -ffp-contract=off -fno-math-errno)
  if(CMAKE_SIZEOF_VOID_P EQUAL 4 AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(i.86|x86|x86_64|AMD64)$")
    target_compile_options(orchard_flags INTERFACE -msse2 -mfpmath=sse)
  endif()
  # GCC 12 joins halves of vectors wrongly for ARM: the nearest point of a segment was one of its ends.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    target_compile_options(orchard_flags INTERFACE -fno-tree-slp-vectorize)
  endif()
  # Position-independent code calls its own functions, and does not look up whether somebody else has replaced them.
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-fno-semantic-interposition orchard_has_no_interposition)
  if(orchard_has_no_interposition)
    target_compile_options(orchard_flags INTERFACE -fno-semantic-interposition)
  endif()
  set(orchard_werror -Werror)
endif()
if(ORCHARD_WARNINGS_AS_ERRORS)
  target_compile_options(orchard_flags INTERFACE ${orchard_werror})
endif()
if(ORCHARD_SANITIZE)
  # Null pointers and outside objects are found by the address sanitizer already. Alignment and overflow of pointers are
  # asked at each access, which doubles the time that compiling takes: only in the run-time, where files are mapped.
  set(runtime_targets "$<IN_LIST:$<TARGET_PROPERTY:NAME>,orchard_runtime;orchard_runtime_headers>")
  target_compile_options(orchard_flags INTERFACE
    -fsanitize=address,undefined -fno-sanitize=null,object-size,vptr
    "$<$<NOT:${runtime_targets}>:-fno-sanitize=alignment,pointer-overflow>"
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
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
    set_target_properties(${owner} PROPERTIES POSITION_INDEPENDENT_CODE ${ARG_PIC} CXX_STANDARD 20)
    target_compile_options(${owner} PRIVATE ${ARG_OPTIONS})
    target_link_libraries(${owner} PRIVATE orchard_flags ${ARG_LINK})
    target_precompile_headers(${owner} PRIVATE ${ARG_HEADERS})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# orchard_unite(target [BY_FOLDER]): with ORCHARD_UNITY, files are compiled eight at a time, in the order in which they are
# listed, or BY_FOLDER those of a folder, and all NAME_cgal.cpp at once: what they instantiate of CGAL takes longer than all
# else. So a name in an unnamed namespace is unique in its target. Files with options of their own are compiled by
# themselves. A build without ORCHARD_UNITY compiles less after a change.
function(orchard_unite target)
  cmake_parse_arguments(ARG "BY_FOLDER" "" "" ${ARGN})
  if(NOT ORCHARD_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(count 0)
  foreach(source IN LISTS sources)
    if(source MATCHES "_cgal\\.cpp$")
      set(group cgal)
    elseif(ARG_BY_FOLDER)
      cmake_path(GET source PARENT_PATH folder)
      cmake_path(GET folder FILENAME group)
      if(group STREQUAL "kernels")  # compiled by themselves, so that what they inline is the same in every build
        continue()
      endif()
    else()
      math(EXPR group "${count} / 8")
      math(EXPR count "${count} + 1")
    endif()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${target}_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
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
  # As C++20 whatever the project around it asks for: see packed_tree.h.
  set_target_properties(${target} PROPERTIES CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON)
  if(name STREQUAL "runtime")  # without ORCHARD_UNITY file by file, so that a game links no more than it uses
    orchard_precompile_once(${target} runtime PIC HEADERS ${ORCHARD_STANDARD_HEADERS})
    orchard_unite(${target} BY_FOLDER)
  else()
    orchard_precompile_once(${target} construction PIC LINK Eigen3::Eigen TBB::tbb
      HEADERS ${ORCHARD_CONSTRUCTION_HEADERS} ${ORCHARD_TBB_HEADERS})
    orchard_unite(${target})
  endif()
  # Until 1.0.0 a minor version may change an interface, so two of them are two libraries.
  set(interface ${PROJECT_VERSION_MAJOR})
  if(PROJECT_VERSION_MAJOR EQUAL 0)
    set(interface 0.${PROJECT_VERSION_MINOR})
  endif()
  set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${interface}
    WINDOWS_EXPORT_ALL_SYMBOLS ON)
  orchard_development_component(development ${ARG_COMPONENT})
  install(TARGETS ${target} EXPORT orchard-${ARG_COMPONENT}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${ARG_COMPONENT}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${ARG_COMPONENT} NAMELINK_COMPONENT ${development}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${development})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${development})
  set_property(GLOBAL APPEND PROPERTY ORCHARD_COMPONENTS ${ARG_COMPONENT})
endfunction()

# Where headers and all else go that only a compiler needs: the component itself, or, where packages are made
# (ORCHARD_DEVELOPMENT_APART), one beside it.
function(orchard_development_component result component)
  if(ORCHARD_DEVELOPMENT_APART)
    set(${result} ${component}_development PARENT_SCOPE)
  else()
    set(${result} ${component} PARENT_SCOPE)
  endif()
endfunction()

# orchard_pkg_config(module name COMPONENT component DESCRIPTION text [REQUIRES ..]): NAME.pc for a library that needs no
# package files but those, so that make, meson and others find it. It can be moved with its prefix.
function(orchard_pkg_config module name)
  cmake_parse_arguments(ARG "" "COMPONENT;DESCRIPTION" "REQUIRES" ${ARGN})
  if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}" OR IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
    return()  # a prefix that can be moved is what the file is about
  endif()
  file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  get_target_property(type orchard_${module} TYPE)
  set(also)
  if(type STREQUAL "STATIC_LIBRARY")  # what a program in C does not link by itself
    foreach(library IN LISTS CMAKE_CXX_IMPLICIT_LINK_LIBRARIES)
      if(library MATCHES "^(stdc\\+\\+|c\\+\\+|m)$")
        string(APPEND also " -l${library}")
      endif()
    endforeach()
  endif()
  list(JOIN ARG_REQUIRES ", " requires)
  file(WRITE ${PROJECT_BINARY_DIR}/${name}.pc "prefix=\${pcfiledir}/${up}
libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}
includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}

Name: ${name}
Description: ${ARG_DESCRIPTION}
Version: ${PROJECT_VERSION}
Requires: ${requires}
Libs: -L\${libdir} -lorchard_${module}${also}
Cflags: -I\${includedir}
")
  orchard_development_component(development ${ARG_COMPONENT})
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT ${development})
endfunction()

# One export set per component, so that find_package(orchard COMPONENTS runtime) needs nothing else.
function(orchard_install_package)
  include(CMakePackageConfigHelpers)
  orchard_development_component(runtime_development runtime)
  set(directory ${CMAKE_INSTALL_LIBDIR}/cmake/orchard)
  get_property(components GLOBAL PROPERTY ORCHARD_COMPONENTS)
  list(REMOVE_DUPLICATES components)
  foreach(component IN LISTS components)
    orchard_development_component(development ${component})
    install(EXPORT orchard-${component} NAMESPACE orchard:: DESTINATION ${directory} COMPONENT ${development})
  endforeach()
  # Beside that of the run-time, which installs runtime/LICENSE itself.
  if(ORCHARD_CONSTRUCTION)
    list(APPEND components apps)
    list(REMOVE_ITEM components runtime)
    foreach(component IN LISTS components)
      install(FILES ${PROJECT_SOURCE_DIR}/LICENSES/GPL-3.0-or-later.txt
        DESTINATION ${CMAKE_INSTALL_DOCDIR}/${component} COMPONENT ${component})
    endforeach()
  endif()
  configure_package_config_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/orchardConfig.cmake.in
    ${PROJECT_BINARY_DIR}/orchardConfig.cmake INSTALL_DESTINATION ${directory})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/orchardConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/orchardConfig.cmake ${PROJECT_BINARY_DIR}/orchardConfigVersion.cmake
    DESTINATION ${directory} COMPONENT ${runtime_development})
endfunction()
