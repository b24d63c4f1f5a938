#pragma once
#include <vector>

#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// medial_mesh(axis), and the face of the axis that each triangle is cut from: faces first, then walls, numbered
// through.
struct AxisTriangles {
  MedialMesh mesh;
  std::vector<Index> face_of_triangle;
};
AxisTriangles axis_triangles(const MedialAxis& axis);

}  // namespace orchard::detail
