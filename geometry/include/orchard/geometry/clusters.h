#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Sets of adjacent coplanar triangles (dissertation 6.2.2), numbered in the order of their first triangle.
struct Clusters {
  std::vector<Index> of_triangle;
  Rows triangles;  // of each cluster, ascending
  Index count() const { return triangles.size(); }
};

// Grows each cluster from its lowest triangle across edges, while the normal stays within `angle` (radians) of the
// first triangle's. normals: unit; neighbors: kNone where there is none.
Clusters find_clusters(std::span<const Vector> normals, std::span<const std::array<Index, 3>> neighbors, double angle);

}  // namespace orchard
