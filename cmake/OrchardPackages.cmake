# Packages of the construction pipeline. Eigen and OpenMesh come first, by their own config files: CGAL brings find
# modules of the same names that get in the way.
find_package(Eigen3 CONFIG REQUIRED)
find_package(OpenMesh CONFIG REQUIRED)
find_package(TBB CONFIG REQUIRED)
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE ON)
find_package(CGAL CONFIG REQUIRED)
