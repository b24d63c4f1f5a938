#pragma once
#include <array>
#include <string>

#include "orchard/geometry/mesh.h"

namespace orchard {

// What stands between a mesh and a solid. Counts of faults, with the first of each kind to look at.
struct MeshReport {
  Index vertices = 0, triangles = 0, components = 0;
  std::int64_t euler_characteristic = 0;  // used vertices - edges + triangles
  Index boundary_edges = 0;               // one triangle only
  Index non_manifold_edges = 0;           // three triangles or more
  Index non_manifold_vertices = 0;        // more than one fan of triangles
  Index misoriented_edges = 0;            // both triangles run along the edge in the same direction
  Index degenerate_triangles = 0;         // a repeated corner or no area
  Index unused_vertices = 0;              // harmless
  Index inside_out_components = 0;        // turned against the rest, and no cavity: no other component could hold them
  std::array<Index, 2> first_boundary_edge{kNone, kNone}, first_non_manifold_edge{kNone, kNone},
      first_misoriented_edge{kNone, kNone};  // vertices
  Index first_non_manifold_vertex = kNone;
  Index first_degenerate_triangle = kNone, first_inside_out_triangle = kNone;
  double area = 0, volume = 0;  // volume < 0: inside out

  bool closed() const { return boundary_edges == 0; }
  bool manifold() const { return non_manifold_edges == 0 && non_manifold_vertices == 0; }
  // Closed, manifold, consistently oriented outward, without degenerate triangles.
  bool solid() const {
    return closed() && manifold() && misoriented_edges == 0 && degenerate_triangles == 0 &&
           inside_out_components == 0 && volume > 0;
  }
  // One line that says what is wrong and which element is the first such one; empty if solid().
  std::string faults() const;
};

// O(n log n), works on any triangles. Precondition: validate(mesh) passes.
MeshReport check_mesh(const TriangleMesh& mesh);

// Turns an inside-out mesh round; everything else about it must be in order. Returns whether it was turned.
// Throws InputError with MeshReport::faults() if the mesh is not a solid afterwards.
bool require_solid(TriangleMesh& mesh);

}  // namespace orchard
