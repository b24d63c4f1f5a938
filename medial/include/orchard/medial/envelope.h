#pragma once
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {

struct EnvelopeOptions {
  double cell = 1.0 / 200;  // edge of the grid's cells, in diagonals of the box around all balls: in [1e-4, 0.5]
};

struct EnvelopeMesh {
  TriangleMesh mesh;
  Index lost = 0;  // balls that the mesh has nothing of within a cell: what is thinner than that may be lost
};

// The surface of what a medial mesh stands for, the union of the balls, cones and slabs of its vertices, edges and
// triangles: a closed manifold mesh, counter-clockwise seen from outside, with vertices on the envelope but for
// rounding.
//
// The sign of the distance to the union is taken at the corners of a grid, whose cubes are halved where the envelope
// can be; each of the smallest is cut into six tetrahedra, which fit together, and the part of the envelope in each is
// one or two triangles. So it is closed and manifold whatever the balls are; what is thinner than a cell may be lost,
// which `lost` tells, and edges are cut off by less than a cell. Time and size grow with the area over the square of
// the cell. Deterministic; parallel. Throws InputError unless validate(mesh) passes, the options are in range, and the
// union is met by the grid at all.
EnvelopeMesh envelope_mesh(const MedialMesh& mesh, const EnvelopeOptions& options = {}, const Progress& progress = {});

}  // namespace orchard
