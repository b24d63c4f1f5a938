# Packages for Debian and Ubuntu, by cpack in a build tree: the program from one with the construction, the run-time's library
# and what a compiler needs of it from one without (tools/packages makes all three).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME orchard)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "the orchard authors")
set(ORCHARD_CONTACT "The orchard authors <noreply@users.noreply.github.com>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT "${ORCHARD_CONTACT}")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Copyright, changelog, compressed manual page: what Debian wants besides.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
set(CPACK_ORCHARD_SOURCE ${PROJECT_SOURCE_DIR})

if(ORCHARD_CONSTRUCTION)
  set(CPACK_COMPONENTS_ALL apps)
  set(CPACK_DEBIAN_APPS_PACKAGE_NAME orchard-tools)
  set(CPACK_DEBIAN_APPS_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_APPS_PACKAGE_RECOMMENDS xvfb)
  set(CPACK_COMPONENT_APPS_DESCRIPTION "medial axes and certified sphere-trees of triangle meshes
The program orchard turns a closed triangle mesh into its medial-axis
surface, that into a tight sphere-tree which is certified to cover the mesh,
and asks sphere-trees whether bodies touch. It draws pictures of all of it
and writes files for ParaView.")
  if(ORCHARD_PYTHON)
    list(APPEND CPACK_COMPONENTS_ALL python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-orchard-geometry)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    string(REGEX MATCH "^[0-9]+\\.[0-9]+" python_version "${PYTHON_VERSION}")
    string(REGEX REPLACE "^[0-9]+\\." "" python_minor "${python_version}")
    math(EXPR python_minor "${python_minor} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${python_version}), python3 (<< 3.${python_minor}), python3-numpy")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-matplotlib)
    set(CPACK_COMPONENT_PYTHON_DESCRIPTION "medial axes, sphere-trees and collision answers from Python
The module orchard_geometry turns triangle meshes into medial axes and
certified sphere-trees, makes sets of spheres with a promise, and asks
100,000 collision queries in one call.")
  endif()
else()
  set(CPACK_COMPONENTS_ALL runtime runtime_development)
  set(library liborchard-runtime${PROJECT_VERSION_MAJOR})
  if(PROJECT_VERSION_MAJOR EQUAL 0)
    set(library liborchard-runtime0.${PROJECT_VERSION_MINOR})
  endif()
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${library})
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_MULTIARCH same)
  string(REGEX REPLACE "^.*[^0-9.]([0-9.]+)$" "\\1" interface ${library})
  file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
  file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs "liborchard_runtime ${interface} ${library} (>= ${PROJECT_VERSION})\n")
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/triggers
    ${PROJECT_BINARY_DIR}/debian/shlibs)
  set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "sphere-trees and collision answers in real time
Loads sphere-trees and tells whether two placed bodies touch, level by level:
at every moment the answer is no, which is certain, or maybe, with an upper
bound on how far apart the bodies are; a last level tests triangles exactly.

This package has the shared library.")
  set(CPACK_DEBIAN_RUNTIME_DEVELOPMENT_PACKAGE_NAME liborchard-runtime-dev)
  set(CPACK_DEBIAN_RUNTIME_DEVELOPMENT_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_RUNTIME_DEVELOPMENT_PACKAGE_MULTIARCH same)
  set(CPACK_DEBIAN_RUNTIME_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
  set(CPACK_DEBIAN_RUNTIME_DEVELOPMENT_PACKAGE_DEPENDS "${library} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
  set(CPACK_COMPONENT_RUNTIME_DEVELOPMENT_DESCRIPTION "sphere-trees and collision answers in real time (development)
Loads sphere-trees and tells whether two placed bodies touch, level by level:
at every moment the answer is no, which is certain, or maybe, with an upper
bound on how far apart the bodies are; a last level tests triangles exactly.

This package has the headers, for C++20 and for C, and the files by which
CMake and pkg-config find the library.")
endif()
include(CPack)
