#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {

// What import_axis() made of a medial mesh.
struct ImportedAxis {
  MedialAxis axis;
  SurfaceSampling sampling;  // the samples, and behind them the first contact of each ball, by vertex
  Index refused = 0;      // balls whose centre is not inside the solid: no vertex of the axis, and none of their cells
  Index adjusted = 0;     // vertices whose radius was off by more than tolerance::kSameRadius: it is the right one now
  double adjustment = 0;  // the largest such difference, in mesh units
};

// A medial axis from the medial mesh of any other system, so that trees can be built from it.
//
// Vertices are the mesh's balls with their centres inside the solid; their radii are the centres' distances to the
// surface. A ball's first contact is the surface's point nearest to its centre, which is added to the axis's points as
// PointOrigin::repair. Every point of `sampling` becomes a contact of the ball that comes nearest to it. So a vertex
// has one contact at least, where a Voronoi vertex has four, and validate(axis, surface) does not hold. Neighbours and
// faces are the mesh's edges and triangles; a face's two points are those contacts of its corners that are farthest
// apart. The angle of a vertex is the largest that two of its contacts are seen at, pi at most.
//
// Deterministic; one nearest-point query a ball and one search a sample: O((m + n) log m). Throws InputError unless
// surface.solid(), or if no ball is left.
ImportedAxis import_axis(const Surface& surface, const MedialMesh& mesh, SurfaceSampling sampling,
                         const Progress& progress = {});

}  // namespace orchard
