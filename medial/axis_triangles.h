#pragma once
#include <vector>

#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// The result of medial_mesh(axis), and for each triangle the face of the axis that it is cut from. Faces and topology
// faces are numbered together, faces first.
struct AxisTriangles {
  MedialMesh mesh;
  std::vector<Index> face_of_triangle;
};
AxisTriangles axis_triangles(const MedialAxis& axis);

}  // namespace orchard::detail
