#pragma once
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"

// Meshes and points to ask surfaces about, and the slow answers.
namespace orchard::test {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

// Needles, points, coincident and crossing triangles: legal for distances.
TriangleMesh degenerate_soup();
std::vector<NamedMesh> solids();
// Those, open meshes and soups, far smaller and larger, and far from the origin.
std::vector<NamedMesh> all_meshes();

// In and around the box, on vertices, edges and faces, at distances from a rounding to a size off them, and far away.
std::vector<Point> queries_for(const Surface& surface, int count, std::uint64_t seed);

ClosestPoint closest_by_brute_force(const Surface& surface, const Point& query);
double winding_number(const Surface& surface, const Point& query);

}  // namespace orchard::test
