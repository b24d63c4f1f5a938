#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// Groups coplanar triangles of a mesh.
namespace orchard {

// Sets of adjacent coplanar triangles, numbered in the order of their first triangle. Source: dissertation 6.2.2.
struct Clusters {
  std::vector<Index> of_triangle;  // The cluster of each triangle.
  Rows triangles;                  // The triangles of each cluster, ascending.
  Index count() const { return triangles.size(); }
};

// Grows each cluster from its lowest triangle across edges, as long as the normals stay within `angle` (radians) of the
// normal of the first triangle. `normals` have unit length; `neighbors` are kNone where there is none.
Clusters find_clusters(std::span<const Vector> normals, std::span<const std::array<Index, 3>> neighbors, double angle);

}  // namespace orchard
