#pragma once
#include <array>
#include <string>

#include "orchard/geometry/mesh.h"

// Checks whether a mesh is a solid, and counts its faults.
namespace orchard {

// Counts of the faults that keep a mesh from being a solid, with the first fault of each kind.
struct MeshReport {
  Index vertices = 0, triangles = 0, components = 0;
  std::int64_t euler_characteristic = 0;  // Used vertices - edges + triangles.
  Index boundary_edges = 0;               // Edges with one triangle.
  Index non_manifold_edges = 0;           // Edges with three triangles or more.
  Index non_manifold_vertices = 0;        // Vertices with more than one fan of triangles.
  Index misoriented_edges = 0;            // Edges that both triangles pass in the same direction.
  Index degenerate_triangles = 0;         // Triangles with a repeated corner or without area.
  Index unused_vertices = 0;              // Vertices without triangles, which are harmless.
  // Components that are oriented against the rest and cannot be cavities, since no other component could contain them.
  Index inside_out_components = 0;
  std::array<Index, 2> first_boundary_edge{kNone, kNone}, first_non_manifold_edge{kNone, kNone},
      first_misoriented_edge{kNone, kNone};  // Each edge as two vertices.
  Index first_non_manifold_vertex = kNone;
  Index first_degenerate_triangle = kNone, first_inside_out_triangle = kNone;
  double area = 0, volume = 0;  // The volume is below 0 if the mesh is inside out.

  bool closed() const { return boundary_edges == 0; }
  bool manifold() const { return non_manifold_edges == 0 && non_manifold_vertices == 0; }
  // Returns whether the mesh is closed, manifold and consistently oriented outward, without degenerate triangles.
  bool solid() const {
    return closed() && manifold() && misoriented_edges == 0 && degenerate_triangles == 0 &&
           inside_out_components == 0 && volume > 0;
  }
  // Returns a line that names each fault and its first element; empty if solid().
  std::string faults() const;
};

// Counts the faults of any triangles. Precondition: validate(mesh) passes. O(n log n).
MeshReport check_mesh(const TriangleMesh& mesh);

// Reverses the orientation of a mesh that is inside out but has no other fault. Returns whether the mesh was reversed.
// Throws InputError with MeshReport::faults() if the mesh is not a solid afterwards.
bool require_solid(TriangleMesh& mesh);

}  // namespace orchard
