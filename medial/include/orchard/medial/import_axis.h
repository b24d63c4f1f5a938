#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/medial_mesh.h"

// Converts a medial mesh of any system into a MedialAxis, so that sphere-trees can be built from it.
namespace orchard {

// The result of import_axis().
struct ImportedAxis {
  MedialAxis axis;
  // The samples, followed by the first contact of each ball in the order of the vertices.
  SurfaceSampling sampling;
  // Balls with a centre that is not inside the solid. The axis has neither these balls nor their cells.
  Index refused = 0;
  // Vertices whose radius was off by more than tolerance::kSameRadius and was replaced by the right one.
  Index adjusted = 0;
  double adjustment = 0;  // The largest such difference, in mesh units.
};

// Builds a medial axis from the medial mesh of any system.
//
// The vertices are the balls with their centres inside the solid; their radii are the distances of the centres to the
// surface. The first contact of a ball is the point of the surface nearest to its centre. It is added to the points of
// the axis as PointOrigin::repair. Every point of `sampling` becomes a contact of the ball that comes nearest to it. So
// a vertex has at least one contact, whereas a Voronoi vertex has four, and validate(axis, surface) does not hold. The
// neighbours and faces are the edges and triangles of the mesh. The two points of a face are the contacts of its
// corners that are farthest apart. The angle of a vertex is the largest angle, at most pi, at which two of its contacts
// are seen.
//
// Throws InputError unless surface.solid(), or if no ball is left. The result is deterministic. Takes O((m + n) log m):
// one nearest-point query for each ball and one search for each sample.
ImportedAxis import_axis(const Surface& surface, const MedialMesh& mesh, SurfaceSampling sampling,
                         const Progress& progress = {});

}  // namespace orchard
