# VTK: only what orchard uses, so that configuring and linking stay quick. Include it after OrchardPackages (VTK brings a
# find module for Eigen of its own). VTK's package files want C. Its targets are made visible to all folders, because
# whoever links the static library orchard::viz links them too.
enable_language(C)
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
set(orchard_vtk_components CommonCore CommonDataModel CommonExecutionModel FiltersCore FiltersSources IOImage IOXML
  ImagingCore RenderingCore RenderingFreeType RenderingOpenGL2)
if(ORCHARD_BENCH)
  list(APPEND orchard_vtk_components IOGeometry)  # a rival of the OBJ reader
endif()
find_package(VTK 9.1 CONFIG REQUIRED COMPONENTS ${orchard_vtk_components})
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL OFF)
