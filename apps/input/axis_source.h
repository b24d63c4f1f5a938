#pragma once
#include <filesystem>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "orchard/medial/build.h"

namespace orchard::apps {

// The files that replace steps of building a medial axis. At most one of them is given.
struct AxisSource {
  std::filesystem::path points;   // surface points: .xyz, or .ply or .obj, whose faces are not looked at
  std::filesystem::path diagram;  // a Voronoi diagram of points on the mesh, a .vor file; taken as it is
  std::filesystem::path axis;     // the axis itself, a file of any system that read_axis() reads

  std::vector<std::filesystem::path> files() const;  // those that are given
};

// The contents of a source.
struct OwnInput {
  MedialBuildInput input;
  double max_moved = 0;         // the largest distance by which a point was moved onto the surface, in mesh units
  MeshReadReport reading = {};  // of the file of points
};

// Reads a source. Points are moved to the nearest place of the surface, except those of a diagram, which must lie on
// it. Throws InputError, which names file and line.
OwnInput read_axis_source(const AxisSource& source, const Surface& surface);

}  // namespace orchard::apps
