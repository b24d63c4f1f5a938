#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/repair.h"

// The steps of repair_mesh(). Each changes the mesh and adds to its counts in the report.
namespace orchard::detail {

// In repair_soup.cpp: steps that treat triangles independently of their connections.
Index erase_marked(TriangleMesh& mesh, const std::vector<bool>& marked);  // returns how many triangles were erased
void weld_vertices(TriangleMesh& mesh, MeshRepairReport& report);
void drop_duplicates(TriangleMesh& mesh, MeshRepairReport& report);
void drop_degenerate(TriangleMesh& mesh, MeshRepairReport& report);
void drop_unused_vertices(TriangleMesh& mesh, MeshRepairReport& report);

// In repair_join.cpp: joins corners of open edges up to `distance` apart. `radius` is the bounding radius.
void join_vertices(TriangleMesh& mesh, double distance, double radius, MeshRepairReport& report);

// In repair_manifold.cpp: steps that treat the connections of triangles.
void orient_components(TriangleMesh& mesh, MeshRepairReport& report);
void cut_apart(TriangleMesh& mesh, MeshRepairReport& report);

// In repair_holes.cpp: any triangles are allowed; those around a hole must be oriented consistently. `radius` is the
// bounding radius.
void fill_holes(TriangleMesh& mesh, const RepairMeshOptions& options, double radius, MeshRepairReport& report);

// In repair_cgal.cpp: returns triangles over a closed polyline. They refer to its points and have the same orientation.
// Empty if the polyline cannot be filled.
std::vector<std::array<Index, 3>> triangulate_polyline(std::span<const Point> polyline);

// In repair_parts.cpp: removes components that repeat another one, and orients the rest. Precondition: closed,
// manifold, and neighbours are oriented consistently.
void orient_parts(TriangleMesh& mesh, MeshRepairReport& report);

}  // namespace orchard::detail
