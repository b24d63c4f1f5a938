#pragma once
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/tolerance.h"

// Repairs a mesh into a solid where that is safe, and reports every change.
namespace orchard {

// Which corners are joined and which holes are filled. Lengths are fractions of the bounding radius.
struct RepairMeshOptions {
  double join_distance = tolerance::kJoin;  // Open corners up to this distance apart are joined; 0 joins none.
  Index max_hole_edges = 100;               // Holes with more boundary edges stay open; 0 fills none.
  // Holes that are wider than this stay open, unless they are cracks: holes of which no boundary point is farther than
  // max_crack_width from the diameter.
  double max_hole_diameter = 0.5;
  double max_crack_width = 1e-3;
};

// Counts of the changes that repair_mesh() made; 0 where it changed nothing.
struct MeshRepairReport {
  Index vertices_welded = 0;  // Vertices welded into another at the same place.
  Index vertices_joined = 0;  // Vertices joined to another at a slightly different place.
  double max_join = 0;        // The largest distance that joining moved a vertex, in mesh units.
  Index unused_vertices_dropped = 0;
  Index degenerate_dropped = 0;  // Triangles without area.
  Index neighbors_split = 0;     // Triangles split across the long edge of such a triangle, so that no gap opens.
  Index duplicates_dropped = 0;  // Triangles on the same corners as another one.
  Index flipped = 0;             // Triangles reoriented to agree with their neighbours.
  Index edges_cut = 0;           // Edges cut where more than two triangles met.
  Index vertices_split = 0;      // Vertices split where parts of the surface touched at a point.
  // Holes that were closed because they are no wider than the join distance, such as a vertex that lies on an edge.
  Index cracks_closed = 0;
  Index cracks_triangles = 0;  // Triangles that close the cracks.
  Index holes_filled = 0, triangles_added = 0;
  double max_hole = 0;               // The largest diameter of a filled hole, in mesh units.
  Index holes_left = 0;              // Holes that are too large to fill.
  double max_hole_left = 0;          // The diameter of the widest of them, in bounding radii.
  Index edges_of_hole_left = 0;      // The number of boundary edges of that hole.
  Index parts_turned_outward = 0;    // Components that were inside out.
  Index cavities_turned_inward = 0;  // Components inside another one that faced outward.
  bool solid = false;                // MeshReport::solid() of the result.
  std::string faults = {};           // MeshReport::faults() of the result.

  bool changed() const { return !lines().empty(); }
  // Returns a line of text for each kind of change.
  std::vector<std::string> lines() const;
};

// Repairs a mesh towards a solid, with those changes alone that keep the surface in place, in these steps:
// - Vertices at the same place are welded where a seam or a triangle without area requires it.
// - Corners of open edges that differ by rounding are joined, the nearest first, so that an edge closed in this way is
//   not joined to a part of the surface beside it.
// - Degenerate and duplicate triangles are removed.
// - Triangles are reoriented to agree with the majority of their component.
// - Edges and vertices where solids touch are cut apart; each triangle stays with the one across the solid between them
//   (Gueziec et al. 2001).
// - Small holes are filled (CGAL's triangulate_hole_polyline, after Liepa 2003).
// - Components are oriented outward, and those wholly inside another one, which are cavities, inward.
// Only the filling of holes adds surface, and only joining moves vertices, by RepairMeshOptions::join_distance at most.
// Larger holes, strips with one side and faces inside a solid stay as they are, which the report states. A mesh without
// faults keeps every byte. Throws InputError if validate(mesh) does. O(n log n).
MeshRepairReport repair_mesh(TriangleMesh& mesh, const RepairMeshOptions& options = {});

}  // namespace orchard
