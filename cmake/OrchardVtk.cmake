# VTK: only what orchard uses, so that configuring and linking stay quick. Include it after OrchardPackages (VTK brings a
# find module for Eigen of its own). VTK's package files want C. Its targets are made visible to all folders, because
# what links the static library orchard::viz links them too.
enable_language(C)
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
set(orchard_vtk_components CommonCore CommonDataModel CommonExecutionModel FiltersCore FiltersSources IOCore IOImage IOXML
  ImagingCore InteractionStyle RenderingCore RenderingFreeType RenderingOpenGL2 RenderingUI)
if(ORCHARD_BENCH)
  list(APPEND orchard_vtk_components IOGeometry)  # a rival of the OBJ reader
endif()
# Where apt could not install it, tools/unpack-vtk has put it here.
file(GLOB orchard_unpacked_vtk "${PROJECT_SOURCE_DIR}/build/vtk/usr/lib/*/cmake/vtk-*")
find_package(VTK 9.1 CONFIG QUIET COMPONENTS ${orchard_vtk_components} HINTS ${orchard_unpacked_vtk})
if(NOT VTK_FOUND)
  message(FATAL_ERROR "VTK 9.1 or later cannot be used; tools/install-packages gets it, -DORCHARD_VIZ=OFF does without. "
    "${VTK_NOT_FOUND_MESSAGE}")
endif()
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL OFF)
