#pragma once
#include <filesystem>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "orchard/medial/build.h"

namespace orchard::apps {

// Files of the user's that stand in for steps of building a medial axis; one of them at most.
struct AxisSource {
  std::filesystem::path points;   // surface points: .xyz, or .ply or .obj, whose faces are not looked at
  std::filesystem::path diagram;  // a Voronoi diagram of points on the mesh, a .vor file; taken as it is
  std::filesystem::path axis;     // the axis itself, a file of any system that read_axis() reads

  std::vector<std::filesystem::path> files() const;  // those that are given
};

// What a source holds.
struct OwnInput {
  MedialBuildInput input;
  double max_moved = 0;         // by how much points were moved onto the surface, in mesh units
  MeshReadReport reading = {};  // of the file of points
};

// Points are moved to the nearest place of the surface; those of a diagram must be there. Throws InputError, which
// names file and line.
OwnInput read_axis_source(const AxisSource& source, const Surface& surface);

}  // namespace orchard::apps
