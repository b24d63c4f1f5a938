#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"
#include "reconstruction.h"

namespace orchard::detail {

struct BallDepth;  // quality_parts.h

// A maximum that was searched by branch and bound; lengths in mesh units.
struct SearchedMax {
  double max = 0;               // attained, or what was known before
  double upper = 0;             // proven, up to rounding: nowhere more
  Point place = Point::Zero();  // of the reconstruction's boundary, where it is attained, if it is above what was known
  Sphere ball{Point::Zero(), 0};  // of the reconstruction, there
};

// How deep inside the solid the boundary of the reconstruction lies where it lies deepest: dents, slits and gaps
// between sheets, which samples of the surface may all miss. Searched is above `known` only, deep down in cubes
// (deep_dents.h), below the surface along its normals (shell_dents.h), both divided until none can have more than the
// larger of `accuracy` (mesh units) and 2 % above what was found, or until `max_parts` were: `upper` says then how much
// is left open. Parallel, and the same for any number of threads. A query of each kind for each part: some tens of
// thousands of parts on most meshes, whose number grows slowly as `known` falls.
SearchedMax max_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double accuracy,
                     Index max_parts);

// A place of the reconstruction's boundary inside the solid.
struct Dent {
  Point place;
  double depth = 0;  // mesh units
  Vector outward;    // unit, to the nearest place of the surface
};

// Places of the boundary that are deeper than `min_depth`, the deepest first, as far as they are seen from the centres
// of these balls of the solid: where the reconstruction does not hold one as deep as it is, the way straight out of the
// ball around its centre ends at its boundary, from ball to ball. Places in reach of none are missed; a search of cubes
// finds fewer in ten times the time. One query of each kind for each ball. Parallel, deterministic.
std::vector<Dent> dents_seen_from(std::span<const Sphere> balls, const Surface& surface,
                                  const Reconstruction& reconstruction, double min_depth);

// What saves queries where it is of all vertices, or of the middles of all triangles.
struct KnownDepths {
  std::span<const BallDepth> vertices, triangles;
};

// How far the reconstruction reaches out of the solid at most: that is attained. `upper` bounds how far any ball
// reaches beyond the place of the surface that is nearest to its centre, which is no less than what protrudes, and more
// where a ball closes a crevice and ends in the solid again. Cells are halved until that is within the larger of
// `accuracy` and 2 % above what was attained, or until `max_cells` were looked at. Parallel, and the same for any
// number of threads.
SearchedMax max_protrusion(const Surface& surface, const MedialMesh& mesh, const KnownDepths& depths, double known,
                           double accuracy, Index max_cells);

// Whether a ball that is interpolated on these three may reach beyond the place of the surface that is nearest to its
// centre by more than `limit` (mesh units): false is proven, up to rounding. Their centres are in the solid, and their
// radii are the distances of these to the surface, which mostly decides without a query.
bool may_stick_out(const Surface& surface, const std::array<Sphere, 3>& balls, double limit);

}  // namespace orchard::detail
