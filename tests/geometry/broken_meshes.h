#pragma once
#include <array>
#include <initializer_list>
#include <vector>

#include "orchard/geometry/repair.h"

// Meshes that are no solids, and ways to make them.
namespace orchard::test {

TriangleMesh unit_box();
// Vertices at the same place become one, as in a file without connectivity that a reader welds.
TriangleMesh welded(const TriangleMesh& mesh);
TriangleMesh turned(TriangleMesh mesh);
TriangleMesh with(TriangleMesh mesh, std::initializer_list<std::array<Index, 3>> triangles);

struct BrokenMesh {
  const char* name;
  TriangleMesh mesh;
  double volume;  // of the solid that it stands for
  MeshRepairReport expected;
};

// What has one meaning only.
std::vector<BrokenMesh> repairable();

}  // namespace orchard::test
