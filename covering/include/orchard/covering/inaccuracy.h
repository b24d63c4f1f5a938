#pragma once
#include "orchard/geometry/surface.h"
#include "orchard/geometry/tolerance.h"

// Proven bounds on how far spheres extend outside a solid.
namespace orchard {

// A lower and an upper bound; the true value always lies between them.
struct Bounds {
  double lower = 0, upper = 0;
};

// How far two bounds may differ: by a fraction of the bounding radius or by a fraction of the distance itself,
// whichever is larger.
struct DistanceTolerance {
  double of_radius = tolerance::kInaccuracy;
  double of_distance = 0.01;
};

// Returns bounds on Hubbard's inaccuracy of a sphere: the largest distance to the surface from a point of the sphere's
// surface that lies outside the solid, or 0 if there is none (dissertation 5.3.2, 5.3.5).
// Lemma 5.1 holds for convex objects only, so this is a branch and bound over the sphere, which uses that the distance
// is 1-Lipschitz. Lengths are in mesh units. Unless the work limit is reached, the bounds differ by at most the
// tolerance, or by at most 1e-6 R if the tolerance is smaller than that. Throws InputError unless surface.solid().
Bounds inaccuracy(const Surface& surface, const Sphere& sphere, const DistanceTolerance& tolerance = {});

// Returns bounds on the largest distance to the solid from a point of the closed ball, or 0 if the ball lies inside.
// The run-time's bound on separation is derived from this distance. Unlike the inaccuracy, it also counts the interior
// of the ball, which matters where a ball fills a hole or a gap.
// The search is a branch and bound over cubes. Width and errors are those of inaccuracy(). The upper bound is never
// above distance_bound(). `at_least` is a known lower bound, such as the inaccuracy's, and makes the search faster.
Bounds farthest_from_solid(const Surface& surface, const Sphere& ball, const DistanceTolerance& tolerance = {},
                           double at_least = 0);

// Decides whether the distance of farthest_from_solid() is at most `limit` (mesh units). If it is, upper <= limit. If
// it is not, lower > limit, and `at` is a point of the ball at least `lower` away from the solid. If neither holds, the
// work limit was reached.
Bounds farthest_against(const Surface& surface, const Sphere& ball, double limit, Point& at);

// Returns an upper bound on the largest distance to the solid from any point of the closed ball: max(0, radius + signed
// distance of the centre), rounded upward. It holds for every solid, convex or not, since the signed distance is
// 1-Lipschitz.
double distance_bound(double signed_distance_of_center, double radius);

}  // namespace orchard
