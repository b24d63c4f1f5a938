#pragma once
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/medial/medial_mesh.h"

// Converts a medial mesh into the surface mesh that it stands for.
namespace orchard {

// The options of envelope_mesh().
struct EnvelopeOptions {
  // The edge length of the grid's cells, in [1e-4, 0.5] diagonals of the box around all balls. Smaller cells follow the
  // envelope more closely and cost more.
  double cell = 1.0 / 200;
};

// The result of envelope_mesh().
struct EnvelopeMesh {
  TriangleMesh mesh;
  // The number of balls of which no part of the mesh is nearer than a cell. Parts thinner than a cell may be lost.
  Index lost = 0;
};

// Returns the surface of the union of the balls, cones and slabs of a medial mesh's vertices, edges and triangles. The
// result is a closed manifold mesh, counter-clockwise seen from outside, whose vertices lie on the envelope up to
// rounding.
//
// The function computes the sign of the distance to the union at the corners of a grid, whose cubes it halves where
// they may contain the envelope. It cuts each of the smallest cubes into six tetrahedra, which fit together; the part
// of the envelope in each tetrahedron is one triangle or two. So the mesh is closed and manifold for all balls. Parts
// thinner than a cell may be lost, which `lost` counts, and edges are cut off by less than a cell.
//
// Throws InputError unless validate(mesh) passes, the options are in range, and the grid meets the union. The result is
// deterministic; the work is parallel. Time and size grow with the area over the square of the cell.
EnvelopeMesh envelope_mesh(const MedialMesh& mesh, const EnvelopeOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
