#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"
#include "reconstruction.h"

namespace orchard::detail {

struct BallDepth;  // quality_parts.h

// A maximum that was found by branch and bound. Lengths are in mesh units.
struct SearchedMax {
  double max = 0;    // a value that is attained, or that was known before the search
  double upper = 0;  // a proven upper bound, up to rounding
  // The place of the reconstruction's boundary where `max` is attained, if the search has found more than was known.
  Point place = Point::Zero();
  Sphere ball{Point::Zero(), 0};  // the ball of the reconstruction at that place
};

// Finds the deepest place inside the solid that the boundary of the reconstruction has: dents, slits and gaps between
// sheets, all of which samples of the surface may miss. The search looks only for places deeper than `known`. It
// examines cubes deep down (deep_dents.h) and prisms along the normals below the surface (shell_dents.h), and divides
// them until none can contain a place that is deeper than the best one by more than `accuracy` (mesh units) and 2 %, or
// until it has examined `max_parts`; `upper` then states what is still possible. Parallel; the result is the same for
// any number of threads. Each part costs one query of each kind. Most meshes need some tens of thousands of parts, and
// the number grows slowly as `known` falls.
SearchedMax max_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double accuracy,
                     Index max_parts);

// A place of the reconstruction's boundary inside the solid.
struct Dent {
  Point place;
  double depth = 0;  // mesh units
  Vector outward;    // unit, to the nearest place of the surface
};

// Returns places of the boundary that are deeper than `min_depth`, the deepest first, as seen from the centres of the
// given balls of the solid. Where the reconstruction does not contain such a ball as deep as the ball itself, the
// search follows the path straight out of the ball around its centre, from ball to ball, to its end at the boundary. It
// misses dents that no such path reaches, but a search by cubes finds fewer of them in ten times the time. Each ball
// costs one query of each kind. Parallel, deterministic.
std::vector<Dent> dents_seen_from(std::span<const Sphere> balls, const Surface& surface,
                                  const Reconstruction& reconstruction, double min_depth);

// Depths that are known already, which saves queries where the balls are those of all vertices or of the middles of all
// triangles.
struct KnownDepths {
  std::span<const BallDepth> vertices, triangles;
};

// Returns how far the reconstruction protrudes from the solid; `max` is attained. `upper` bounds how far any ball
// reaches beyond the place of the surface that is nearest to its centre. That is at least the protrusion, and more
// where a ball closes a crevice and ends in the solid again. Cells are halved until `upper` is within the larger of
// `accuracy` and 2 % of the attained value, or until `max_cells` have been examined. Parallel; the result is the same
// for any number of threads.
SearchedMax max_protrusion(const Surface& surface, const MedialMesh& mesh, const KnownDepths& depths, double known,
                           double accuracy, Index max_cells);

// Whether some ball that is interpolated on these three may reach more than `limit` (mesh units) beyond the place of
// the surface that is nearest to its centre. The answer false is proven, up to rounding. The centres of the three have
// to be in the solid, and their radii have to be their distances to the surface; mostly that decides without a query.
bool may_stick_out(const Surface& surface, const std::array<Sphere, 3>& balls, double limit);

}  // namespace orchard::detail
