#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/repair.h"

// The steps of repair_mesh(), each a change of the mesh that its counts in the report tell.
namespace orchard::detail {

// repair_soup.cpp: triangles as a bag.
Index erase_marked(TriangleMesh& mesh, const std::vector<bool>& marked);  // triangles; returns how many
void weld_vertices(TriangleMesh& mesh, MeshRepairReport& report);
void drop_duplicates(TriangleMesh& mesh, MeshRepairReport& report);
void drop_degenerate(TriangleMesh& mesh, MeshRepairReport& report);
void drop_unused_vertices(TriangleMesh& mesh, MeshRepairReport& report);

// repair_join.cpp: joins corners of open edges up to `distance` apart; `radius` is the bounding radius.
void join_vertices(TriangleMesh& mesh, double distance, double radius, MeshRepairReport& report);

// repair_manifold.cpp: how triangles hang together.
void orient_components(TriangleMesh& mesh, MeshRepairReport& report);
void cut_apart(TriangleMesh& mesh, MeshRepairReport& report);

// repair_holes.cpp: any triangles; those around a hole must agree. `radius` is the
// bounding radius.
void fill_holes(TriangleMesh& mesh, const RepairMeshOptions& options, double radius, MeshRepairReport& report);

// repair_cgal.cpp: triangles over a closed polyline, which name its points and all turn the same way; empty if there is
// no way to do it.
std::vector<std::array<Index, 3>> triangulate_polyline(std::span<const Point> polyline);

// repair_parts.cpp: drops components that repeat another one, turns the rest. Precondition: closed, manifold,
// neighbours agree.
void orient_parts(TriangleMesh& mesh, MeshRepairReport& report);

}  // namespace orchard::detail
