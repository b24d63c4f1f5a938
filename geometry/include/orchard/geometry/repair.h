#pragma once
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {

// Which corners are one and which holes are small: lengths in bounding radii.
struct RepairMeshOptions {
  double join_distance = tolerance::kJoin;  // open corners up to this far apart are joined; 0: none
  Index max_hole_edges = 100;               // more than this on its boundary: left open; 0: fill none
  double max_hole_diameter = 0.5;           // wider than this: left open, unless
  double max_crack_width = 1e-3;            // no boundary point is farther than this from the hole's diameter
};

// What was done to a mesh, so that nothing changes silently. Counts of things; zero where nothing was done.
struct MeshRepairReport {
  Index vertices_welded = 0;  // each into another at the same place
  Index vertices_joined = 0;  // each to another that is not quite at the same place
  double max_join = 0;        // of those: how far one was moved at most, in mesh units
  Index unused_vertices_dropped = 0;
  Index degenerate_dropped = 0;  // triangles without area
  Index neighbors_split = 0;     // across the long edge of such a triangle, so that no gap opens
  Index duplicates_dropped = 0;  // a second triangle on the same corners
  Index flipped = 0;             // triangles turned to agree with their neighbours
  Index edges_cut = 0;           // where more than two triangles met
  Index vertices_split = 0;      // where parts of the surface touched at a point
  Index cracks_closed = 0;       // holes no wider than corners are joined over, as where a vertex lies on an edge
  Index cracks_triangles = 0;    // that close them
  Index holes_filled = 0, triangles_added = 0;
  double max_hole = 0;               // of those filled: diameter in mesh units
  Index holes_left = 0;              // too large to fill; of the widest of them:
  double max_hole_left = 0;          // its diameter in bounding radii, and
  Index edges_of_hole_left = 0;      // the edges of its boundary
  Index parts_turned_outward = 0;    // components that were inside out
  Index cavities_turned_inward = 0;  // components inside another one that faced outward
  bool solid = false;                // MeshReport::solid() of the result
  std::string faults = {};           // MeshReport::faults() of the result

  bool changed() const { return !lines().empty(); }
  std::vector<std::string> lines() const;  // one for each kind of thing that was done
};

// Makes a solid of a mesh where that is safe, which is where the surface keeps its place: vertices at the same place
// are welded where a seam or a triangle without area asks for it; corners of open edges that differ by rounding are
// joined, the nearest first, so that nothing that is closed then is joined to a sheet beside it; degenerate and
// duplicate triangles go; neighbours are turned to agree with the majority of their component; edges and vertices where
// solids touch are cut apart (Gueziec et al. 2001, each triangle stays with the one across the solid between them);
// small holes are filled (CGAL's triangulate_hole_polyline, after Liepa 2003); components are turned outward, those
// wholly inside another one are cavities and turned inward. Only the filling of holes adds surface, and only joining
// moves vertices, by RepairMeshOptions::join_distance at most. Holes that are larger, strips with one side and walls
// inside a solid stay as they are: see the report. A mesh without faults keeps every byte. O(n log n). Throws
// InputError if validate(mesh) does.
MeshRepairReport repair_mesh(TriangleMesh& mesh, const RepairMeshOptions& options = {});

}  // namespace orchard
